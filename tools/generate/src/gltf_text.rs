//! A glTF file under construction, and its two forms: JSON with its bytes embedded, and GLB.
use base64::Engine as _;
use glam::DVec3;
use serde_json::{Value, json};

use crate::cage::Cage;

/// Decimals of numbers in the buffer, as those of OBJ files.
const DECIMALS: f64 = 1e5;

/// A file: its lists by their names, and one buffer.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfText {
    json: Value,
    bytes: Vec<u8>,
}

impl GltfText {
    /// A file without anything but what uses these extensions.
    pub fn new(extensions_used: &[&str]) -> Self {
        let asset = json!({ "version": "2.0", "generator": "planish-generate" });
        Self { json: json!({ "asset": asset, "extensionsUsed": extensions_used, "scene": 0 }), bytes: Vec::new() }
    }

    /// Sets a field of the whole file.
    pub fn set(&mut self, field: &str, value: Value) {
        self.json[field] = value;
    }

    /// Adds an element to a list and returns its index.
    pub fn add(&mut self, list: &str, element: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().expect("a list was asked for");
        list.push(element);
        list.len() - 1
    }

    /// Adds bytes to the buffer and returns the index of their view.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.add("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    /// Adds an accessor of rounded floats, N an element, with their least and greatest; returns its index.
    pub fn floats<const N: usize>(&mut self, values: &[[f64; N]]) -> usize {
        let values: Vec<[f32; N]> = values.iter().map(|value| value.map(rounded)).collect();
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N).map(|c| values.iter().map(|value| value[c]).reduce(pick).unwrap_or_default()).collect()
        };
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"].get(N).copied().unwrap_or("MAT4");
        let (least, greatest) = (bound(f32::min), bound(f32::max));
        let view = self.view(&bytes);
        let accessor = json!({ "bufferView": view, "componentType": 5126, "count": values.len(), "type": kind,
            "min": least, "max": greatest });
        self.add("accessors", accessor)
    }

    /// Adds an accessor of single numbers and returns its index.
    pub fn scalars(&mut self, values: &[f64]) -> usize {
        self.floats(&values.iter().map(|&value| [value]).collect::<Vec<_>>())
    }

    /// Adds an accessor of four joints each and returns its index.
    pub fn joints(&mut self, joints: &[[u8; 4]]) -> usize {
        let view = self.view(joints.as_flattened());
        self.add(
            "accessors",
            json!({ "bufferView": view, "componentType": 5121, "count": joints.len(), "type": "VEC4" }),
        )
    }

    /// Adds an accessor of the triangles of polygons, encoded as FB_ngon_encoding asks: a fan around one vertex each, and never
    /// the same vertex for two in a row. Returns its index.
    pub fn polygons(&mut self, polygons: &[Vec<u32>]) -> usize {
        let triangles = fans(polygons);
        let bytes: Vec<u8> = triangles.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.add(
            "accessors",
            json!({ "bufferView": view, "componentType": 5123, "count": triangles.len(), "type": "SCALAR" }),
        )
    }

    /// A primitive of a cage whose corners with different texture coordinates are different vertices. Also returns the cage's
    /// vertex of each of them.
    pub fn primitive(&mut self, cage: &Cage, material: usize) -> (Value, Vec<u32>) {
        let split = Split::new(cage);
        let positions: Vec<[f64; 3]> = split.vertices.iter().map(|&v| cage.positions[v as usize].to_array()).collect();
        let mut attributes = json!({ "POSITION": self.floats(&positions) });
        if !cage.uvs.is_empty() {
            let uvs: Vec<[f64; 2]> = split.uvs.iter().map(|&uv| cage.uvs[uv as usize].to_array()).collect();
            attributes["TEXCOORD_0"] = json!(self.floats(&uvs));
        }
        let indices = self.polygons(&split.polygons);
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": material,
            "extensions": { "FB_ngon_encoding": {} } });
        (primitive, split.vertices)
    }

    /// The file as JSON, its bytes in it.
    pub fn to_gltf(&self) -> String {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        let uri = format!("data:application/octet-stream;base64,{data}");
        let json = self.with_buffer(json!({ "byteLength": self.bytes.len(), "uri": uri }));
        serde_json::to_string_pretty(&json).expect("JSON can be written") + "\n"
    }

    /// The file as GLB.
    pub fn to_glb(&self) -> Vec<u8> {
        let json = self.with_buffer(json!({ "byteLength": self.bytes.len() }));
        let mut json = serde_json::to_vec(&json).expect("JSON can be written");
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bytes = self.bytes.clone();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let word = |value: usize| (value as u32).to_le_bytes();
        let length = 12 + 8 + json.len() + 8 + bytes.len();
        let header = [b"glTF".as_slice(), &word(2), &word(length), &word(json.len()), b"JSON"].concat();
        [header, json, word(bytes.len()).to_vec(), b"BIN\0".to_vec(), bytes].concat()
    }

    fn with_buffer(&self, buffer: Value) -> Value {
        let mut json = self.json.clone();
        json["buffers"] = json!([buffer]);
        json
    }
}

/// The vertices of a cage split where its texture coordinates differ.
struct Split {
    /// The cage's vertex of each; they ascend, so welding finds the cage again.
    vertices: Vec<u32>,
    uvs: Vec<u32>,
    polygons: Vec<Vec<u32>>,
}

impl Split {
    fn new(cage: &Cage) -> Self {
        let uv_of = |face: usize, corner: usize| cage.face_uvs.get(face).map_or(0, |uvs| uvs[corner]);
        let corners =
            |face: usize| cage.faces[face].iter().enumerate().map(move |(corner, &v)| (v, uv_of(face, corner)));
        let mut pairs: Vec<(u32, u32)> = (0..cage.faces.len()).flat_map(corners).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let index = |pair: (u32, u32)| pairs.binary_search(&pair).expect("all pairs are there") as u32;
        let polygons = (0..cage.faces.len()).map(|face| corners(face).map(index).collect()).collect();
        Self {
            vertices: pairs.iter().map(|pair| pair.0).collect(),
            uvs: pairs.iter().map(|pair| pair.1).collect(),
            polygons,
        }
    }
}

fn fans(polygons: &[Vec<u32>]) -> Vec<u32> {
    let (mut triangles, mut last) = (Vec::new(), None);
    for polygon in polygons {
        let start = usize::from(last == Some(polygon[0]));
        let corner = |i: usize| polygon[(start + i) % polygon.len()];
        (1..polygon.len() - 1).for_each(|i| triangles.extend([corner(0), corner(i), corner(i + 1)]));
        last = Some(corner(0));
    }
    triangles
}

/// A number in no more digits than it is worth: sines differ in their last bits from machine to machine. 0 for -0.
pub fn rounded(value: f64) -> f32 {
    ((value * DECIMALS).round() / DECIMALS + 0.0) as f32
}

/// A vector of rounded numbers, for JSON.
pub fn rounded_vector(vector: DVec3) -> [f64; 3] {
    vector.to_array().map(|value| (value * DECIMALS).round() / DECIMALS + 0.0)
}
