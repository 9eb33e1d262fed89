//! Meshes of the file to those of the scene, and where they stand.
use glam::Affine3A;

use super::animation::Clip;
use super::cage::{self, Cage};
use super::data::Data;
use super::deform;
use super::fault::{Fault, at};
use super::hierarchy::Hierarchy;
use super::materials::Materials;
use super::nodes::own_name;
use crate::deformation::MorphTarget;
use crate::node::Placed;
use crate::obj::Warnings;
use crate::pose::in_single;
use crate::{Deformation, Instance, LoadOptions, Mesh, Node};

/// What meshes are read with.
pub struct Context<'a> {
    pub data: &'a Data<'a>,
    pub hierarchy: &'a Hierarchy,
    pub clip: &'a Clip,
    pub materials: &'a Materials,
    pub nodes: &'a [Node],
    /// All nodes at the scene's first moment.
    pub placed: &'a [Placed],
    pub options: &'a LoadOptions,
}

/// The meshes that the scene shows, in file order, and their instances in the order of nodes.
pub fn read(context: &Context, warnings: &mut Warnings) -> Result<(Vec<Mesh>, Vec<Instance>), Fault> {
    let root = context.data.root;
    let mut users: Vec<Vec<usize>> = vec![Vec::new(); root.meshes.len()];
    for (place, &file_node) in context.hierarchy.file_nodes[..context.hierarchy.shown_count].iter().enumerate() {
        if let Some(mesh) = root.nodes[file_node].mesh {
            at(&root.meshes, mesh.value(), "meshes", || format!("nodes[{file_node}].mesh"))?;
            users[mesh.value()].push(place);
        }
    }
    let (mut meshes, mut instances, mut open_count) = (Vec::new(), Vec::new(), 0);
    for (index, users) in users.iter().enumerate().filter(|(_, users)| !users.is_empty()) {
        let place = format!("meshes[{index}]");
        let sets = |material| context.materials.texcoord_sets(material);
        let cage = cage::read(context.data, &root.meshes[index], sets, &place, context.options, warnings)?;
        let Some(cage) = cage else {
            warnings.push(None, format!("{place}: no triangles: left out"));
            continue;
        };
        cage.slots.iter().try_for_each(|&material| context.materials.check(material, &place))?;
        open_count += usize::from(cage.has_open_triangles);
        Placing { context, file_mesh: index, cage: &cage, meshes: &mut meshes, instances: &mut instances }
            .place(users, warnings)?;
    }
    if open_count > 0 {
        let text = format!(
            "{open_count} meshes have triangles of which nothing says if they were quads: they stay triangles (--quads pairs them)"
        );
        warnings.push(None, text);
    }
    let unused = users.iter().filter(|users| users.is_empty()).count();
    if unused > 0 {
        warnings.push(None, format!("{unused} meshes have no place in the scene: left out"));
    }
    instances.sort_by_key(|&(place, _)| place);
    Ok((meshes, instances.into_iter().map(|(_, instance)| instance).collect()))
}

/// One cage on its way into the scene.
struct Placing<'a> {
    context: &'a Context<'a>,
    file_mesh: usize,
    cage: &'a Cage,
    meshes: &'a mut Vec<Mesh>,
    /// With their nodes' places.
    instances: &'a mut Vec<(usize, Instance)>,
}

impl Placing<'_> {
    /// Makes an instance for every node that has the mesh. Nodes share a mesh unless it has a skin, or moves on them in
    /// different ways.
    fn place(&mut self, users: &[usize], warnings: &mut Warnings) -> Result<(), Fault> {
        let Context { data, hierarchy, .. } = *self.context;
        let file_mesh = &data.root.meshes[self.file_mesh];
        let morphs = deform::morphs(self.cage, file_mesh);
        let first_mesh = self.meshes.len();
        for &place in users {
            let file_node = hierarchy.file_nodes[place];
            let deformation = self.deformation(&morphs, file_node, warnings)?;
            let is_skinned = deformation.as_ref().is_some_and(|deformation| deformation.skin.is_some());
            let transform = if is_skinned { Some(Affine3A::IDENTITY) } else { first_transform(self.context, place)? };
            let Some(transform) = transform else {
                warnings.push(None, format!("nodes[{file_node}]: scaled to nothing: left out"));
                continue;
            };
            let known = (first_mesh..self.meshes.len())
                .find(|&mesh| !is_skinned && self.meshes[mesh].deformation == deformation);
            let mesh = match known {
                Some(mesh) => mesh,
                None => self.add(deformation)?,
            };
            let name = own_name(&data.root.nodes[file_node]).unwrap_or_else(|| self.meshes[mesh].name.clone());
            let node = (!is_skinned).then_some(place);
            self.instances.push((place, Instance { name, mesh, transform, node, materials: self.cage.slots.clone() }));
        }
        Ok(())
    }

    /// How the cage moves on a node; none if it does not.
    fn deformation(
        &self,
        morphs: &[MorphTarget],
        file_node: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<Deformation>, Fault> {
        let Context { data, hierarchy, clip, .. } = *self.context;
        let (file_mesh, node) = (&data.root.meshes[self.file_mesh], &data.root.nodes[file_node]);
        let place = format!("nodes[{file_node}]");
        let has_influences = self.cage.primitives.iter().any(|primitive| !primitive.influences.is_empty());
        let skin = match node.skin {
            None => None,
            Some(_) if !has_influences => {
                warnings.push(None, format!("{place}: a skin, but the mesh has no JOINTS_0: ignored"));
                None
            }
            Some(index) => {
                let skin = at(&data.root.skins, index.value(), "skins", || format!("{place}.skin"))?;
                data.spend(64 * self.cage.control_mesh.positions.len() as u64, &place)?;
                Some(deform::skin(data, self.cage, skin, hierarchy, &format!("skins[{}]", index.value()))?)
            }
        };
        let weights = deform::weights(file_mesh, node, clip.channels.get(&file_node), morphs.len(), &place)?;
        if skin.is_none() && morphs.is_empty() {
            return Ok(None);
        }
        data.spend(morphs.iter().map(|morph| 16 * morph.vertices.len() as u64).sum(), &place)?;
        let weights = weights.filter(|_| !morphs.is_empty());
        Ok(Some(Deformation { points: None, morphs: morphs.to_vec(), weights, skin }))
    }

    fn add(&mut self, deformation: Option<Deformation>) -> Result<usize, Fault> {
        let data = self.context.data;
        let control_mesh = &self.cage.control_mesh;
        data.spend(32 * (control_mesh.positions.len() + control_mesh.face_vertices.len()) as u64, "meshes")?;
        let name = data.root.meshes[self.file_mesh].name.clone().filter(|name| !name.is_empty());
        self.meshes.push(Mesh {
            name: name.unwrap_or_else(|| format!("mesh {}", self.file_mesh)),
            control_mesh: control_mesh.clone(),
            slots: self.cage.slots.iter().map(|material| self.context.materials.slot_name(*material)).collect(),
            face_slots: self.cage.face_slots.clone(),
            deformation,
            ..Mesh::default()
        });
        Ok(self.meshes.len() - 1)
    }
}

/// Where a node is at the scene's first moment; none if it is scaled to nothing at all times. Where it will grow, it is moved
/// alone: poses hide it as long as it is nothing.
fn first_transform(context: &Context, place: usize) -> Result<Option<Affine3A>, Fault> {
    let to_world = &context.placed[place].to_world;
    let transform = in_single(to_world);
    if !transform.is_finite() {
        let file_node = context.hierarchy.file_nodes[place];
        return Err(Fault::new(
            format!("nodes[{file_node}]"),
            "a transform to the world beyond 32-bit floats",
            "a finite one",
        ));
    }
    if transform.matrix3.determinant() != 0.0 {
        return Ok(Some(transform));
    }
    let mut chain = std::iter::successors(Some(place), |&node| context.nodes[node].parent);
    let is_moved = chain.any(|node| !context.nodes[node].is_constant());
    Ok(is_moved.then(|| Affine3A::from_translation(transform.translation.into())))
}
