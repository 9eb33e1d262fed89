//! Point instancers (UsdGeomPointInstancer): every mesh below a prototype becomes an item for every point. What a point does
//! over time is not read: it stays where it is at its first moment.
use std::collections::HashSet;

use glam::{DQuat, DVec3};

use super::attributes::Attributes;
use super::convert;
use super::faces::below;
use super::walk::{Item, Tree};
use crate::MAX_INSTANCES;
use crate::curve::Curve;
use crate::gltf::fault::Fault;
use crate::node::{Node, TransformStep};

/// Where a point puts its prototype.
struct Point {
    prototype: usize,
    steps: [TransformStep; 3],
}

/// Adds the items of all point instancers.
pub fn expand(tree: &mut Tree, rate: f64) -> Result<(), Fault> {
    let is_shown = |item: &Item| item.kind == "PointInstancer" && item.is_rendered && !item.is_prototype;
    let instancers: Vec<usize> = (0..tree.items.len()).filter(|&item| is_shown(&tree.items[item])).collect();
    let mut room = MAX_INSTANCES;
    for instancer in instancers {
        let prim = tree.items[instancer].prim.clone();
        let attributes = Attributes::new(&prim, rate);
        let prototypes: Vec<Vec<usize>> =
            attributes.targets("prototypes")?.iter().map(|path| tree.meshes_below(path)).collect();
        for (number, point) in points(&attributes, prototypes.len())?.into_iter().enumerate() {
            let Some(point) = point else { continue };
            for &mesh in &prototypes[point.prototype] {
                room = room.checked_sub(1).ok_or_else(|| {
                    attributes.fault("protoIndices", format!("more than {MAX_INSTANCES} instances"), "fewer")
                })?;
                place(tree, (instancer, number), &point, mesh);
            }
        }
    }
    Ok(())
}

/// The points of an instancer; none of those that are hidden.
fn points(attributes: &Attributes, prototype_count: usize) -> Result<Vec<Option<Point>>, Fault> {
    let indices = attributes.get("protoIndices", "int[]", convert::integers)?.unwrap_or_default();
    let positions = attributes.get("positions", "point3f[]", convert::vec3s)?.unwrap_or_default();
    let rotations = attributes.get("orientations", "quath[]", convert::quats)?.unwrap_or_default();
    let scales = attributes.get("scales", "float3[]", convert::vec3s)?.unwrap_or_default();
    let ids = attributes.get("ids", "int64[]", convert::integers)?.unwrap_or_default();
    let hidden = attributes.get("invisibleIds", "int64[]", convert::integers)?.unwrap_or_default();
    let hidden: HashSet<i64> = hidden.into_iter().collect();
    let counts = [
        ("positions", positions.len()),
        ("orientations", rotations.len()),
        ("scales", scales.len()),
        ("ids", ids.len()),
    ];
    for (name, count) in counts {
        if count != indices.len() && (count != 0 || name == "positions") {
            let expected = format!("the {} of protoIndices", indices.len());
            return Err(attributes.fault(name, format!("{count} values"), expected));
        }
    }
    let vector = |v: &[f32; 3]| DVec3::from(v.map(f64::from));
    let point = |(number, &index): (usize, &i64)| {
        let prototype = usize::try_from(index).ok().filter(|&index| index < prototype_count).ok_or_else(|| {
            attributes.fault("protoIndices", format!("prototype {index}"), below(prototype_count, "prototypes"))
        })?;
        if hidden.contains(&ids.get(number).copied().unwrap_or(number as i64)) {
            return Ok(None);
        }
        let position = vector(&positions[number]);
        let rotation = rotations.get(number).copied().unwrap_or(DQuat::IDENTITY);
        let scale = scales.get(number).map_or(DVec3::ONE, vector);
        if !(position.is_finite() && rotation.is_finite() && scale.is_finite()) {
            return Err(attributes.fault("positions", format!("point {number} that is not finite"), "finite numbers"));
        }
        let steps = [
            TransformStep::Translate(Curve::constant(position)),
            TransformStep::Rotate(Curve::constant(rotation)),
            TransformStep::Scale(Curve::constant(scale)),
        ];
        Ok(Some(Point { prototype, steps }))
    };
    indices.iter().enumerate().map(point).collect()
}

/// Adds a mesh of a prototype at a point. Its node has the steps of all from the prototype's root down to the mesh.
fn place(tree: &mut Tree, (instancer, number): (usize, usize), point: &Point, mesh: usize) {
    let root = &tree.items[instancer];
    let (parent, path) = (root.node, root.prim.path().as_str().to_owned());
    let item = &tree.items[mesh];
    let (prim, source, above) = (item.prim.clone(), item.source.clone(), item.parent);
    let chain = std::iter::successors(Some(item.node), |&node| tree.nodes[node].parent);
    let mut below_instancer: Vec<usize> = chain.take_while(|&node| node != parent).collect();
    below_instancer.reverse();
    let own = below_instancer.iter().flat_map(|&node| tree.nodes[node].steps.iter().cloned());
    let steps = point.steps.iter().cloned().chain(own).collect();
    let name = format!("{path}[{number}]{}", prim.path().as_str().strip_prefix(&path).unwrap_or_default());
    let visible = tree.visible_below(Some(item.node), &Curve::constant(true));
    let node = Node { steps, visible, ..Node::still(&name, Some(parent)) };
    let kind = "Mesh".to_owned();
    let node_place = tree.nodes.len();
    tree.nodes.push(node);
    let item = Item { prim, kind, node: node_place, parent: above, source, is_rendered: true, is_prototype: false };
    tree.items.push(item);
}
