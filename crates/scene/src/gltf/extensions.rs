//! Which extensions are understood.
use ::gltf::json::Root;

use super::fault::Fault;
use super::primitive::NGON_ENCODING;
use crate::obj::Warnings;

/// The extensions that are understood. Integers of any size are read whether KHR_mesh_quantization is there or not.
const KNOWN: [&str; 9] = [
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    NGON_ENCODING,
];

/// Refuses a file that requires an extension that is not understood, and warns of those that it uses.
pub fn check(root: &Root, warnings: &mut Warnings) -> Result<(), Fault> {
    let unknown = |names: &[String]| -> Vec<String> {
        names.iter().filter(|name| !KNOWN.contains(&name.as_str())).cloned().collect()
    };
    let required = unknown(&root.extensions_required);
    if !required.is_empty() {
        let expected = format!("none but {}", KNOWN.join(", "));
        return Err(Fault::new("extensionsRequired", required.join(", "), expected));
    }
    let used = unknown(&root.extensions_used);
    if !used.is_empty() {
        warnings.push(
            None,
            crate::error::shown(&format!("extensions that are not understood: ignored: {}", used.join(", "))),
        );
    }
    Ok(())
}
