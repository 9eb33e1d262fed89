//! What a stage names but does not have: layers, and files of images.
use openusd::ar::{DefaultResolver, ResolvedPath, Resolver as _};
use openusd::pcp::Error;
use openusd::sdf::{Path, Value};
use openusd::usd::Attribute;

use crate::gltf::fault::Fault;

/// Refuses what leaves a layer out: the scene would be another. What else composition says is a warning.
pub fn check(error: &Error) -> Result<(), Fault> {
    let (asset, by, reason) = match error {
        Error::UnresolvedLayer { asset_path, introduced_by, site_path, .. } => {
            (asset_path, format!("{site_path} of {}", file_name(introduced_by)), None)
        }
        Error::MalformedLayer { asset_path, introduced_by, site_path, reason, .. } => {
            (asset_path, format!("{site_path} of {}", file_name(introduced_by)), Some(reason))
        }
        Error::UnresolvedSublayer { asset_path, introduced_by } => {
            (asset_path, format!("subLayers of {}", file_name(introduced_by)), None)
        }
        Error::MalformedSublayer { asset_path, introduced_by, reason } => {
            (asset_path, format!("subLayers of {}", file_name(introduced_by)), Some(reason))
        }
        _ => return Ok(()),
    };
    let (found, expected) = match reason {
        None => ("nothing".to_owned(), "a layer"),
        Some(reason) => (reason.clone(), "a layer that can be read"),
    };
    Err(Fault::new(crate::error::shown(&format!("@{asset}@, named by {by}")), found, expected))
}

fn file_name(layer: &str) -> &str {
    layer.rsplit('/').next().unwrap_or(layer)
}

/// Where the asset of an attribute is: its resolved path, else the path as written, from the folder of the layer that has it.
pub fn asset(attribute: &Attribute, value: Value) -> Option<String> {
    let written = match value {
        Value::AssetPath(asset) => match asset.resolved_path() {
            Some(resolved) => return Some(resolved.to_owned()),
            None => asset.asset_path().to_owned(),
        },
        Value::String(path) => path,
        _ => return None,
    };
    if written.is_empty() {
        return Some(written);
    }
    let has_value = |(layer, path): &(String, Path)| {
        let layer = attribute.stage().layer(layer);
        layer.is_some_and(|layer| ["default", "timeSamples"].iter().any(|field| layer.data().has_field(path, field)))
    };
    let authored = attribute.property_stack().ok().and_then(|stack| stack.into_iter().find(has_value));
    let layer = authored.map(|(layer, _)| ResolvedPath::new(layer));
    Some(DefaultResolver::new().create_identifier(&written, layer.as_ref()))
}
