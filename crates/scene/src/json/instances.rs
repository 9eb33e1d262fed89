//! Where meshes stand, arrays included.
use glam::{DAffine3, DVec3};
use planish_subdiv::mesh::MAX_COORDINATE;

use super::Fault;
use super::meshes::Meshes;
use super::text::{ArrayText, InstanceText};
use super::transform::{rounded, transform};
use crate::{Bounds, Instance};

/// Most instances of a scene, those of arrays counted one by one.
pub const MAX_INSTANCES: u32 = 1_000_000;

/// The instances that a file lists.
pub fn place(texts: &[InstanceText], meshes: &Meshes) -> Result<Vec<Instance>, Fault> {
    if texts.is_empty() {
        return Err(Fault::new("instances", "none", "1 or more"));
    }
    let mut instances = Vec::new();
    for (index, text) in texts.iter().enumerate() {
        place_one(text, meshes, &mut instances).map_err(|fault| fault.within("instances", index))?;
    }
    Ok(instances)
}

/// Adds the instances of one element.
fn place_one(text: &InstanceText, meshes: &Meshes, instances: &mut Vec<Instance>) -> Result<(), Fault> {
    let (mesh, mesh_bounds) = meshes.get(&text.mesh)?;
    let name = text.name.as_ref().unwrap_or(&text.mesh);
    let base = transform(text)?;
    let Some(array) = &text.array else {
        refuse_too_many(1, instances.len(), "")?;
        instances.push(instance(name.clone(), mesh, &base, &mesh_bounds)?);
        return Ok(());
    };
    // Counted before anything is made: a file of a hundred bytes can claim 2^96 instances.
    refuse_too_many(member_count(array)?, instances.len(), "array.count")?;
    let [columns, rows, layers] = array.count;
    for k in 0..layers {
        for j in 0..rows {
            for i in 0..columns {
                let step = DVec3::from(array.step) * DVec3::new(f64::from(i), f64::from(j), f64::from(k));
                let member = DAffine3 { translation: base.translation + step, ..base };
                instances.push(instance(format!("{name}[{i},{j},{k}]"), mesh, &member, &mesh_bounds)?);
            }
        }
    }
    Ok(())
}

fn member_count(array: &ArrayText) -> Result<u64, Fault> {
    let count = array.count;
    if count.contains(&0) {
        return Err(Fault::new("array.count", format!("{count:?}"), "1 or more along each axis"));
    }
    Ok(count.iter().fold(1, |product: u64, &count| product.saturating_mul(u64::from(count))))
}

fn refuse_too_many(added: u64, before: usize, place: &str) -> Result<(), Fault> {
    let total = added.saturating_add(before as u64);
    if total <= u64::from(MAX_INSTANCES) {
        return Ok(());
    }
    Err(Fault::new(place, format!("{total} instances so far"), format!("at most {MAX_INSTANCES} in all")))
}

fn instance(name: String, mesh: usize, transform: &DAffine3, mesh_bounds: &Bounds) -> Result<Instance, Fault> {
    let too_far = |found: String| Fault::new("", found, format!("points within {MAX_COORDINATE:e}"));
    let kept =
        rounded(transform).ok_or_else(|| too_far(format!("a place at {:?}", transform.translation.to_array())))?;
    let instance = Instance::placed(name, mesh, kept);
    let bounds = instance.bounds(mesh_bounds);
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    if reach > f64::from(MAX_COORDINATE) {
        return Err(too_far(format!("a point {reach:.2e} from the origin")));
    }
    Ok(instance)
}
