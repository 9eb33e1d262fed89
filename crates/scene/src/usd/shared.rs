//! Meshes of which several prims say the same: references to one asset that are no instances.
use openusd::usd;

use crate::gltf::fault::Fault;

/// What a mesh's cage does not depend on: where it stands, and what it looks like.
const APART: [&str; 6] = ["xformOp", "visibility", "purpose", "extent", "material:binding", "primvars:displayOpacity"];

/// Where all that a mesh and its subsets say is written, as layers and paths: meshes that have it from the same places are one.
/// None for what changes with time, which references may shift.
pub fn opinions(mesh: &usd::Prim, subsets: &[usd::Prim]) -> Result<Option<String>, Fault> {
    let mut places = String::new();
    for prim in std::iter::once(mesh).chain(subsets) {
        let failed = |error| Fault::new(prim.path().as_str(), format!("{error:#}"), "properties that can be read");
        if prim.has_clips().map_err(failed)? {
            return Ok(None);
        }
        for name in prim.property_names().map_err(failed)? {
            if APART.iter().any(|apart| name.as_str().starts_with(apart)) {
                continue;
            }
            let attribute = prim.attribute(name);
            if attribute.num_time_samples().map_err(failed)? > 0 {
                return Ok(None);
            }
            for (layer, path) in attribute.property_stack().map_err(failed)? {
                // No path of a prim has a space.
                places.extend([layer.as_str(), " ", path.as_str(), "\n"]);
            }
        }
    }
    Ok(Some(places))
}
