//! Cages, and where they stand.
use std::collections::HashMap;

use glam::Affine3A;
use openusd::usd;

use super::attributes::Attributes;
use super::cage::{self, Cage};
use super::convert;
use super::faces::{Faces, below};
use super::materials::Materials;
use super::shared;
use super::skeleton::Skeleton;
use super::skin::Skins;
use super::walk::{Item, Tree};
use crate::gltf::fault::Fault;
use crate::node::Placed;
use crate::obj::Warnings;
use crate::pose::in_single;
use crate::{Deformation, Instance, LoadOptions, Mesh};

/// What instances are made of.
pub struct Context<'a> {
    pub tree: &'a Tree,
    /// All nodes at the scene's first moment.
    pub placed: &'a [Placed],
    pub skins: &'a Skins<'a>,
    /// Time codes a second.
    pub rate: f64,
    /// The scene's first moment, seconds.
    pub time: f64,
    pub is_z_up: bool,
    pub options: &'a LoadOptions,
}

/// Meshes and instances.
#[derive(Default)]
pub struct Meshes {
    pub meshes: Vec<Mesh>,
    pub instances: Vec<Instance>,
    /// What prims in prototypes have become; none if they have no faces.
    known: HashMap<String, Option<Known>>,
    /// And meshes by what they are made of, with the texture coordinates that their materials name.
    same: HashMap<(String, Vec<String>), Option<Known>>,
}

#[derive(Clone, Copy)]
struct Known {
    mesh: usize,
    color: Option<[f32; 3]>,
}

/// Reads all meshes that renders show.
pub fn read(context: &Context, materials: &mut Materials, warnings: &mut Warnings) -> Result<Meshes, Fault> {
    let mut meshes = Meshes::default();
    for (place, item) in context.tree.items.iter().enumerate() {
        if item.kind == "Mesh" && item.is_rendered && !item.is_prototype {
            meshes.place(context, (place, item), materials, warnings)?;
        }
    }
    Ok(meshes)
}

impl Meshes {
    fn place(
        &mut self,
        context: &Context,
        (place, item): (usize, &Item),
        materials: &mut Materials,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        let attributes = Attributes::new(&item.prim, context.rate);
        let subsets = subsets(&attributes, item)?;
        let whole = materials.bound(context.tree, place, warnings)?;
        let mut slots = vec![whole];
        for subset in &subsets {
            slots.push(materials.own(subset, warnings)?.or(whole));
        }
        // A mesh with a skin has one instance.
        let skeleton = context.skins.skeleton(context.tree, place)?;
        let known = match self.known.get(&item.source) {
            Some(&known) if skeleton.is_none() => known,
            _ => {
                let uv_names = slots.iter().flatten().filter_map(|&slot| materials.uv_names[slot].clone()).collect();
                let known = self.read(context, (item, &subsets), skeleton, uv_names, warnings)?;
                self.known.insert(item.source.clone(), known);
                known
            }
        };
        let Some(Known { mesh, color }) = known else { return Ok(()) };
        let has_skin = self.meshes[mesh].deformation.as_ref().is_some_and(|deformation| deformation.skin.is_some());
        let node = skeleton.filter(|_| has_skin).map_or(item.node, |skeleton| skeleton.node);
        let Some(transform) = first_transform(context, node)? else {
            warnings.push(None, format!("{}: scaled to nothing: left out", attributes.path()));
            return Ok(());
        };
        let plain = color.map(|color| materials.plain(color));
        let materials = slots.into_iter().map(|slot| slot.or(plain)).collect();
        let name = context.tree.nodes[item.node].name.clone();
        self.instances.push(Instance { name, mesh, transform, node: Some(node), materials });
        Ok(())
    }

    /// Reads a mesh, unless another is the same. `uv_names`: primvars of texture coordinates that its materials name.
    fn read(
        &mut self,
        context: &Context,
        (item, subsets): (&Item, &[usd::Prim]),
        skeleton: Option<&Skeleton>,
        uv_names: Vec<String>,
        warnings: &mut Warnings,
    ) -> Result<Option<Known>, Fault> {
        let opinions = if skeleton.is_some() { None } else { shared::opinions(&item.prim, subsets)? };
        let same = opinions.map(|opinions| (opinions, uv_names.clone()));
        if let Some(&known) = same.as_ref().and_then(|same| self.same.get(same)) {
            return Ok(known);
        }
        let attributes = Attributes::new(&item.prim, context.rate);
        let cage = cage::read(&attributes, &uv_names, context.options, warnings)?;
        let known = cage.map(|cage| self.add(context, item, subsets, cage)).transpose()?;
        if let (Some(skeleton), Some(known)) = (skeleton, known) {
            self.bind(context, skeleton, &attributes, known.mesh, warnings)?;
        }
        self.same.extend(same.map(|same| (same, known)));
        Ok(known)
    }

    /// Adds what a skeleton does to a mesh.
    fn bind(
        &mut self,
        context: &Context,
        skeleton: &Skeleton,
        attributes: &Attributes,
        mesh: usize,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        let mesh = &mut self.meshes[mesh];
        let vertex_count = mesh.control_mesh.positions.len();
        let mut deformation = context.skins.deformation(skeleton, attributes, vertex_count, warnings)?;
        deformation.points = mesh.deformation.take().and_then(|deformation| deformation.points);
        let moves = deformation.points.is_some() || deformation.skin.is_some() || !deformation.morphs.is_empty();
        mesh.deformation = moves.then_some(deformation);
        Ok(())
    }

    fn add(&mut self, context: &Context, item: &Item, subsets: &[usd::Prim], cage: Cage) -> Result<Known, Fault> {
        let deformation = cage.points.map(|points| Deformation { points: Some(points), ..Deformation::default() });
        let mut mesh = Mesh { name: last(&item.prim), control_mesh: cage.control_mesh, deformation, ..Mesh::default() };
        if !subsets.is_empty() {
            mesh.slots = std::iter::once(mesh.name.clone()).chain(subsets.iter().map(last)).collect();
            mesh.face_slots = face_slots(context, subsets, &cage.faces)?;
        }
        self.meshes.push(mesh);
        Ok(Known { mesh: self.meshes.len() - 1, color: cage.color })
    }
}

/// A prim's own name.
fn last(prim: &usd::Prim) -> String {
    prim.path().as_str().rsplit('/').next().unwrap_or_default().to_owned()
}

/// The subsets of a mesh that have materials of their own.
fn subsets(attributes: &Attributes, item: &Item) -> Result<Vec<usd::Prim>, Fault> {
    let failed = |error: &dyn std::fmt::Display| attributes.fault("children", error.to_string(), "prims");
    let mut subsets = Vec::new();
    for child in item.prim.children().map_err(|error| failed(&error))? {
        let kind = child.type_name().map_err(|error| failed(&error))?;
        if kind.is_none_or(|kind| kind.as_str() != "GeomSubset") {
            continue;
        }
        let family = Attributes::new(&child, 1.0).get("familyName", "a token", convert::token)?;
        if family.as_deref() == Some("materialBind") {
            subsets.push(child);
        }
    }
    Ok(subsets)
}

/// The slot of every face: of a subset, else the mesh's own, the first.
fn face_slots(context: &Context, subsets: &[usd::Prim], faces: &Faces) -> Result<Vec<u32>, Fault> {
    let mut slots = vec![0; faces.sizes.len()];
    for (slot, subset) in (1..).zip(subsets) {
        let attributes = Attributes::new(subset, context.rate);
        for index in attributes.get("indices", "int[]", convert::integers)?.unwrap_or_default() {
            let kept = usize::try_from(index).ok().and_then(|face| faces.kept.get(face));
            let expected = || below(faces.kept.len(), "faces");
            let kept = kept.ok_or_else(|| attributes.fault("indices", format!("face {index}"), expected()))?;
            if let Some(face) = *kept {
                slots[face as usize] = slot;
            }
        }
    }
    Ok(slots)
}

/// Where a node is at the scene's first moment; none if it is scaled to nothing at all times. Where it will grow, it is moved
/// alone: poses hide it as long as it is nothing.
pub fn first_transform(context: &Context, place: usize) -> Result<Option<Affine3A>, Fault> {
    let nodes = &context.tree.nodes;
    let transform = in_single(&context.placed[place].to_world);
    if !transform.is_finite() {
        let found = "a transform to the world beyond 32-bit floats";
        return Err(Fault::new(nodes[place].name.clone(), found, "a finite one"));
    }
    if transform.matrix3.determinant() != 0.0 {
        return Ok(Some(transform));
    }
    let mut chain = std::iter::successors(Some(place), |&node| nodes[node].parent);
    let is_moved = chain.any(|node| !nodes[node].is_constant());
    Ok(is_moved.then(|| Affine3A::from_translation(transform.translation.into())))
}
