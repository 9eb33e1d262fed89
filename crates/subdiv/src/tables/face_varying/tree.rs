//! A face-varying channel by itself: where in a face which of its patches lies.
//!
//! A channel is irregular at the ends of seams, where the surface may be regular. To refine the surface there for the sake of
//! coordinates would cost points and patches in every frame; so a channel that nothing displaces by is refined on its own, as
//! deep as it can be, and looked up in a quadtree for each Ptex face.

use super::FaceVaryingTable;
use crate::error::Error;
use crate::mesh::ControlMesh;
use crate::refine::{MAX_LEVEL, RefineOptions, Refinement};
use crate::tables::Tables;
use crate::topology::{Location, NONE};

/// The first channel of a mesh, as quadtrees.
///
/// A *branch* is a word: bits 30-31 say what it is, the others which. [`NONE`] is nothing: a face that is not drawn.
///
/// | kind | meaning |
/// |---|---|
/// | 0 | node: four branches, those of the quarters at (0,0), (1,0), (1,1), (0,1) |
/// | 1 | patch: 16 values, row by row, of a bicubic B-spline over the square |
/// | 2 | quad: values at the four corners, bilinear between them |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TexTree {
    /// The branch of each Ptex face.
    pub roots: Vec<u32>,
    /// Nodes.
    pub nodes: Vec<[u32; 4]>,
    /// Values of each patch.
    pub patches: Vec<[u32; 16]>,
    /// Values of each quad.
    pub quads: Vec<[u32; 4]>,
    /// The values.
    pub values: Vec<[f32; 2]>,
}

impl TexTree {
    /// A patch's branch.
    pub const PATCH: u32 = 1 << 30;
    /// A quad's branch.
    pub const QUAD: u32 = 2 << 30;

    /// The first channel of a mesh; none if it has none. Fails as refinement does.
    pub fn new(mesh: &ControlMesh) -> Result<Option<Self>, Error> {
        if mesh.face_varying.is_empty() {
            return Ok(None);
        }
        let options = RefineOptions { max_level: MAX_LEVEL, ..RefineOptions::default() };
        let tables = Tables::new(&Refinement::new(mesh, options)?);
        let Some(channel) = tables.face_varying.first() else { return Ok(None) };
        Ok(Some(Self::of(&tables, channel)))
    }

    fn of(tables: &Tables, channel: &FaceVaryingTable) -> Self {
        let mut tree =
            Self { roots: vec![NONE; tables.ptex_faces.len()], values: channel.values.clone(), ..Self::default() };
        for (index, patch) in tables.patches.iter().enumerate() {
            let location = patch.info.location;
            // The spline of a bilinear function is exact, but sums 16 products where 4 do.
            if channel.is_linear {
                tree.add_quad(location, channel.corner_values(index as u32));
            } else {
                tree.put(location, Self::PATCH | tree.patches.len() as u32);
                tree.patches.push(channel.patches[index]);
            }
        }
        for (face, values) in tables.irregular.iter().zip(&channel.faces) {
            let is_leaf = face.children == [NONE; 4] && values[0] != NONE;
            if is_leaf {
                tree.add_quad(face.info.location, [0, 1, 2, 3].map(|corner| values[corner]));
            }
        }
        tree
    }

    fn add_quad(&mut self, location: Location, values: [u32; 4]) {
        self.put(location, Self::QUAD | self.quads.len() as u32);
        self.quads.push(values);
    }

    /// Makes a square's branch this one, and the nodes above it.
    fn put(&mut self, location: Location, branch: u32) {
        let mut parent: Option<(u32, usize)> = None;
        for level in (0..location.depth).rev() {
            let node = self.branch(location.ptex_face, parent);
            let node = if node == NONE { self.add_node(location.ptex_face, parent) } else { node };
            let [u, v] = [location.u, location.v].map(|corner| corner >> level & 1);
            parent = Some((node, [[0, 3], [1, 2]][usize::from(u)][usize::from(v)]));
        }
        *self.branch_mut(location.ptex_face, parent) = branch;
    }

    fn add_node(&mut self, ptex_face: u32, parent: Option<(u32, usize)>) -> u32 {
        let node = self.nodes.len() as u32;
        self.nodes.push([NONE; 4]);
        *self.branch_mut(ptex_face, parent) = node;
        node
    }

    fn branch(&self, ptex_face: u32, parent: Option<(u32, usize)>) -> u32 {
        parent.map_or_else(|| self.roots[ptex_face as usize], |(node, quarter)| self.nodes[node as usize][quarter])
    }

    fn branch_mut(&mut self, ptex_face: u32, parent: Option<(u32, usize)>) -> &mut u32 {
        match parent {
            Some((node, quarter)) => &mut self.nodes[node as usize][quarter],
            None => &mut self.roots[ptex_face as usize],
        }
    }

    /// Several meshes' trees as one; roots follow each other, [`NONE`] for the Ptex faces, of which the counts are given, of meshes
    /// without a channel.
    pub fn merged(trees: &[(u32, Option<Self>)]) -> Self {
        let mut merged = Self::default();
        for (ptex_face_count, tree) in trees {
            let Some(tree) = tree else {
                merged.roots.extend((0..*ptex_face_count).map(|_| NONE));
                continue;
            };
            merged.append(tree);
        }
        merged
    }

    /// Appends another tree: its roots, and what they name, follow those here.
    pub fn append(&mut self, tree: &Self) {
        let firsts = [self.nodes.len(), self.patches.len(), self.quads.len()].map(|count| count as u32);
        let first_value = self.values.len() as u32;
        let moved = |branch: u32| match branch {
            NONE => NONE,
            _ => branch + firsts[(branch >> 30) as usize],
        };
        self.roots.extend(tree.roots.iter().map(|&root| moved(root)));
        self.nodes.extend(tree.nodes.iter().map(|node| node.map(moved)));
        self.patches.extend(tree.patches.iter().map(|patch| patch.map(|value| value + first_value)));
        self.quads.extend(tree.quads.iter().map(|quad| quad.map(|value| value + first_value)));
        self.values.extend(&tree.values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{FaceVaryingChannel, FaceVaryingInterpolation};
    use crate::tables::FaceVaryingEvaluator;

    /// Two quads whose texture coordinates meet in a seam.
    fn pair() -> ControlMesh {
        ControlMesh {
            positions: [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]
                .map(|[x, y]| [x, y, 0.0])
                .to_vec(),
            face_sizes: vec![4, 4],
            face_vertices: vec![0, 1, 4, 3, 1, 2, 5, 4],
            face_varying: vec![FaceVaryingChannel {
                name: "st".to_owned(),
                values: [
                    [0.0, 0.0],
                    [0.5, 0.0],
                    [0.5, 1.0],
                    [0.0, 1.0],
                    [0.6, 0.0],
                    [1.0, 0.0],
                    [1.0, 1.0],
                    [0.6, 1.0],
                ]
                .to_vec(),
                indices: (0..8).collect(),
            }],
            ..ControlMesh::default()
        }
    }

    /// Area of what a branch has that is no node; every value that it names is there.
    fn area(tree: &TexTree, branch: u32) -> f64 {
        if branch == NONE {
            return 0.0;
        }
        let index = (branch & (TexTree::PATCH - 1)) as usize;
        match branch >> 30 {
            0 => tree.nodes[index].iter().map(|&quarter| 0.25 * area(tree, quarter)).sum(),
            1 => f64::from(u8::from(tree.patches[index].iter().all(|&value| (value as usize) < tree.values.len()))),
            _ => f64::from(u8::from(tree.quads[index].iter().all(|&value| (value as usize) < tree.values.len()))),
        }
    }

    /// What a shader makes of a tree, in f64.
    fn evaluate(tree: &TexTree, mut branch: u32, [mut u, mut v]: [f64; 2]) -> [f64; 2] {
        while branch >> 30 == 0 {
            let [right, up] = [u, v].map(|t| t >= 0.5);
            [u, v] = [2.0 * u - f64::from(u8::from(right)), 2.0 * v - f64::from(u8::from(up))];
            branch = tree.nodes[branch as usize][[[0, 3], [1, 2]][usize::from(right)][usize::from(up)]];
        }
        let index = (branch & (TexTree::PATCH - 1)) as usize;
        let value = |value: u32| tree.values[value as usize].map(f64::from);
        if branch & TexTree::QUAD != 0 {
            let [a, b, c, d] = tree.quads[index].map(value);
            let at = |i: usize| (1.0 - v) * ((1.0 - u) * a[i] + u * b[i]) + v * ((1.0 - u) * d[i] + u * c[i]);
            return [at(0), at(1)];
        }
        let points = tree.patches[index].map(|index| {
            let [s, t] = value(index);
            [s, t, 0.0]
        });
        let [s, t, _] = crate::patch::evaluate(&points, u, v).position;
        [s, t]
    }

    #[test]
    fn a_tree_has_the_values_of_the_tables() {
        let mut mesh = pair();
        for mode in
            [FaceVaryingInterpolation::CornersPlus1, FaceVaryingInterpolation::None, FaceVaryingInterpolation::All]
        {
            mesh.options.face_varying = mode;
            let tree = TexTree::new(&mesh).expect("a mesh").expect("a channel");
            let options = RefineOptions { max_level: MAX_LEVEL, ..RefineOptions::default() };
            // Corners of charts that are not interpolated are irregular.
            assert_eq!(tree.nodes.is_empty(), mode != FaceVaryingInterpolation::None);
            let tables = Tables::new(&Refinement::new(&mesh, options).expect("a mesh"));
            let evaluator = FaceVaryingEvaluator::new(&tables, 0).expect("a channel");
            for face in 0..2 {
                for i in 0..=20 {
                    let (u, v) = (f64::from(i) / 20.0, f64::from(i * i % 21) / 20.0);
                    let expected = evaluator.evaluate(face, u, v).expect("a face");
                    let found = evaluate(&tree, tree.roots[face as usize], [u, v]);
                    for (a, b) in expected.into_iter().zip(found) {
                        assert!((a - b).abs() < 1e-6, "face {face} ({u}, {v}): {found:?}, expected {expected:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn trees_cover_every_face_once_alone_and_merged() {
        let mut mesh = pair();
        mesh.options.face_varying = FaceVaryingInterpolation::None;
        let tree = TexTree::new(&mesh).expect("a mesh").expect("a channel");
        let merged = TexTree::merged(&[(2, Some(tree.clone())), (3, None), (2, Some(tree.clone()))]);
        assert_eq!(merged.roots.len(), 7);
        for (face, expected) in [1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0].into_iter().enumerate() {
            assert!((area(&merged, merged.roots[face]) - expected).abs() < 1e-12, "face {face}");
        }
        assert_eq!(TexTree::new(&ControlMesh { face_varying: Vec::new(), ..pair() }).expect("a mesh"), None);
    }
}
