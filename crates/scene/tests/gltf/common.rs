//! What the tests share: glTF files under construction.
use base64::Engine as _;
use planish_scene::{Error, LoadOptions, Scene, read_gltf};
use serde_json::{Value, json};

/// A glTF file under construction: its JSON, and the one buffer of all its accessors.
#[derive(Clone)]
pub struct File {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl File {
    /// A file of nothing but a scene.
    pub fn new() -> Self {
        let json = json!({ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [] }] });
        Self { json, bytes: Vec::new() }
    }

    /// Adds an element to a list of the file and returns its index.
    pub fn add(&mut self, list: &str, element: Value) -> usize {
        let fields = self.json.as_object_mut().unwrap();
        let list = fields.entry(list).or_insert_with(|| json!([])).as_array_mut().unwrap();
        list.push(element);
        list.len() - 1
    }

    /// Adds a node that the scene shows.
    pub fn root(&mut self, node: Value) -> usize {
        let node = self.add("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(node));
        node
    }

    /// Adds bytes and a view of them.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend_from_slice(bytes);
        self.add("bufferViews", view)
    }

    /// Adds an accessor of floats.
    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"].get(N).copied().unwrap_or("MAT4");
        self.add("accessors", json!({ "bufferView": view, "componentType": 5126, "count": values.len(), "type": kind }))
    }

    /// Adds an accessor of single numbers.
    pub fn scalars(&mut self, values: &[f32]) -> usize {
        self.floats(&values.iter().map(|&value| [value]).collect::<Vec<_>>())
    }

    /// Adds an accessor of indices of 16 bits.
    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|&index| u16::try_from(index).unwrap().to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.add(
            "accessors",
            json!({ "bufferView": view, "componentType": 5123, "count": indices.len(), "type": "SCALAR" }),
        )
    }

    /// Adds an accessor of four joints each.
    pub fn joints(&mut self, joints: &[[u8; 4]]) -> usize {
        let view = self.view(joints.as_flattened());
        self.add(
            "accessors",
            json!({ "bufferView": view, "componentType": 5121, "count": joints.len(), "type": "VEC4" }),
        )
    }

    /// Adds a mesh of one primitive of these positions and triangles.
    pub fn mesh(&mut self, positions: &[[f32; 3]], triangles: &[u32]) -> usize {
        let (positions, indices) = (self.floats(positions), self.indices(triangles));
        self.add("meshes", json!({ "primitives": [{ "attributes": { "POSITION": positions }, "indices": indices }] }))
    }

    /// The first primitive of a mesh.
    pub fn primitive(&mut self, mesh: usize) -> &mut Value {
        &mut self.json["meshes"][mesh]["primitives"][0]
    }

    fn with_buffer(&self, mut buffer: Value) -> Value {
        let mut json = self.json.clone();
        buffer["byteLength"] = json!(self.bytes.len());
        if !self.bytes.is_empty() {
            json["buffers"] = json!([buffer]);
        }
        json
    }

    /// The file as JSON with its buffer in it.
    pub fn to_gltf(&self) -> Vec<u8> {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        let json = self.with_buffer(json!({ "uri": format!("data:application/octet-stream;base64,{data}") }));
        serde_json::to_vec(&json).unwrap()
    }

    /// The file as JSON with its buffer in a file of that name.
    pub fn to_gltf_beside(&self, uri: &str) -> Vec<u8> {
        serde_json::to_vec(&self.with_buffer(json!({ "uri": uri }))).unwrap()
    }

    /// The file as a GLB.
    pub fn to_glb(&self) -> Vec<u8> {
        let mut json = serde_json::to_vec(&self.with_buffer(json!({}))).unwrap();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bytes = self.bytes.clone();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let word = |value: usize| (value as u32).to_le_bytes();
        let length = 12 + 8 + json.len() + 8 + bytes.len();
        let header = [b"glTF".as_slice(), &word(2), &word(length), &word(json.len()), b"JSON"].concat();
        [header, json, word(bytes.len()).to_vec(), b"BIN\0".to_vec(), bytes].concat()
    }

    pub fn read_with(&self, options: &LoadOptions) -> Result<Scene, Error> {
        read_gltf("folder/name.gltf", &self.to_gltf(), options)
    }

    /// The scene of a file that must be read without a warning, but for the one that triangles stay triangles.
    pub fn scene(&self) -> Scene {
        let scene = self.read_with(&LoadOptions::default()).unwrap();
        assert_eq!(self.warnings(), <[String; 0]>::default());
        scene
    }

    /// Warnings, but for the one that triangles stay triangles.
    pub fn warnings(&self) -> Vec<String> {
        let scene = self.read_with(&LoadOptions::default()).unwrap();
        let texts = scene.warnings.into_iter().map(|warning| warning.text);
        texts.filter(|text| !text.contains("they stay triangles")).collect()
    }

    /// The message with which the file is refused, without the file's name.
    pub fn refusal(&self) -> String {
        let message = self.read_with(&LoadOptions::default()).expect_err("the file should be refused").to_string();
        assert!(!message.contains('\n'));
        message.strip_prefix("folder/name.gltf: ").unwrap().to_owned()
    }
}

/// A square of two triangles that share an edge's two vertices.
pub const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// Its triangles.
pub const HALVES: [u32; 6] = [0, 1, 2, 0, 2, 3];

/// A file that shows the square once.
pub fn square() -> File {
    let mut file = File::new();
    file.mesh(&SQUARE, &HALVES);
    file.root(json!({ "mesh": 0 }));
    file
}

/// Marks a mesh' primitives as ones that keep their polygons.
pub fn keep_ngons(file: &mut File, mesh: usize) {
    file.primitive(mesh)["extensions"] = json!({ "FB_ngon_encoding": {} });
}
