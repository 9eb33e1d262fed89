//! A scene file of JSON under construction, and its text: one element a line.
use glam::DVec3;
use serde::Serialize;

/// Digits that tell every 32-bit float from its neighbours.
const DIGITS: usize = 9;

/// What stands in a scene file; the fields are those of the format (docs: formats).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneText {
    /// What the scene shows.
    pub comment: String,
    /// Meshes by name.
    pub meshes: Vec<Mesh>,
    /// Where they stand.
    pub instances: Vec<Instance>,
    /// Cameras that stand still.
    pub cameras: Vec<Camera>,
    /// Cameras that move.
    pub paths: Vec<Path>,
}

/// A mesh and its OBJ file, as seen from the scene file's folder.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields are the format's")]
pub struct Mesh {
    pub name: String,
    pub file: String,
}

/// Where a mesh stands.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields are the format's")]
pub struct Instance {
    pub mesh: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub translate: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotate: Option<Rotation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub array: Option<Array>,
}

/// A turn about an axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields are the format's")]
pub struct Rotation {
    pub axis: [f64; 3],
    pub degrees: f64,
}

/// Copies in rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields are the format's")]
pub struct Array {
    pub count: [u32; 3],
    pub step: [f64; 3],
}

/// A camera that stands still.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields are the format's")]
pub struct Camera {
    pub name: String,
    pub eye: [f64; 3],
    pub target: [f64; 3],
    pub fov: f64,
}

/// A camera that moves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields are the format's")]
pub struct Path {
    pub name: String,
    pub fov: f64,
    pub frames: u32,
    pub keys: Vec<Key>,
}

/// A place that a camera passes through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields are the format's")]
pub struct Key {
    pub eye: [f64; 3],
    pub target: [f64; 3],
}

impl SceneText {
    /// Adds a mesh.
    pub fn mesh(&mut self, name: &str, file: &str) {
        self.meshes.push(Mesh { name: name.to_owned(), file: file.to_owned() });
    }

    /// Adds a camera.
    pub fn camera(&mut self, name: &str, eye: DVec3, target: DVec3, fov: f64) {
        let Key { eye, target } = Key::new(eye, target);
        self.cameras.push(Camera { name: name.to_owned(), eye, target, fov });
    }

    /// The file's text.
    pub fn to_json(&self) -> String {
        let comment = format!("  \"comment\": {}", element(&format!("{} Made by planish-generate.", self.comment)));
        let lists = [
            ("meshes", elements(&self.meshes)),
            ("instances", elements(&self.instances)),
            ("cameras", elements(&self.cameras)),
            ("paths", elements(&self.paths)),
        ];
        let present = lists.iter().filter(|(_, elements)| !elements.is_empty());
        let lists = present.map(|(name, elements)| format!("  \"{name}\": [\n    {}\n  ]", elements.join(",\n    ")));
        let fields: Vec<String> = [comment].into_iter().chain(lists).collect();
        format!("{{\n{}\n}}\n", fields.join(",\n"))
    }
}

impl Key {
    /// A key whose coordinates are written in no more digits than they are worth.
    pub fn new(eye: DVec3, target: DVec3) -> Self {
        Self { eye: rounded(eye), target: rounded(target) }
    }
}

/// A vector whose coordinates are written in no more digits than they are worth.
pub fn rounded(vector: DVec3) -> [f64; 3] {
    vector.to_array().map(|value| {
        let text = format!("{value:.*e}", DIGITS - 1);
        // Adding 0 makes 0 of -0.
        text.parse::<f64>().expect("what is printed as a number is one") + 0.0
    })
}

fn elements<T: Serialize>(list: &[T]) -> Vec<String> {
    list.iter().map(element).collect()
}

fn element<T: Serialize>(element: &T) -> String {
    serde_json::to_string(element).expect("numbers and strings can be written as JSON")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_have_nine_digits() {
        let vector = DVec3::new(1.0 / 3.0, -2e10 / 3.0, -0.0);
        let digits = rounded(vector);
        assert_eq!(digits, [0.333333333, -6666666670.0, 0.0]);
        assert!(digits[2].is_sign_positive());
    }

    #[test]
    fn every_element_has_a_line_and_absent_lists_none() {
        let mut text = SceneText { comment: "A \"thing\".".to_owned(), ..SceneText::default() };
        text.mesh("a", "b\\c.obj");
        text.instances.push(Instance { mesh: "a".to_owned(), scale: Some([1.0, -2.0, 0.5]), ..Instance::default() });
        let expected = "{\n  \"comment\": \"A \\\"thing\\\". Made by planish-generate.\",\n  \"meshes\": [\n    \
            {\"name\":\"a\",\"file\":\"b\\\\c.obj\"}\n  ],\n  \"instances\": [\n    {\"mesh\":\"a\",\"scale\":[1.0,-2.0,0.5]}\n  ]\n}\n";
        assert_eq!(text.to_json(), expected);
    }
}
