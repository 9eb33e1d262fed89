//! The tables of a cage: which configurations its faces, edges and vertices have after one step, and each one's weights once.

use std::collections::HashMap;

use crate::basis::grid::{Extent, GridTable, grid_table};
use crate::basis::limit::{LimitMasks, Sector, around};
use crate::basis::poly::{BORDER, CUT, Poly};
use crate::basis::step::Step;
use crate::basis::walk::{Walk, walk};
use crate::error::Error;
use crate::limit::LimitTable;
use crate::mesh::{ControlMesh, Creasing, INFINITE_SHARPNESS};
use crate::scheme::{Rules, Scheme};
use crate::stencil::{StencilRow, StencilTable};
use crate::tables::slots::ptex_faces;
use crate::tables::{BasisEdge, BasisPatch, BasisTable, DensitySlots, LevelPoints, TABLE_TRIANGLE, Tables};
use crate::topology::{Level, NONE};

/// The tessellator makes 64 segments at most.
pub const MAX_TABLE_LEVEL: u32 = 6;

impl Tables {
    /// Tables of a cage for the method `table`: the step to level 1, its limit points, and basis functions of 2^`level` segments a side.
    ///
    /// # Errors
    /// When the scheme does not take the cage: other faces than it knows, edges or vertices that are not manifold, hierarchical edits.
    ///
    /// # Panics
    /// If `level` is above [`MAX_TABLE_LEVEL`].
    pub fn of_basis(mesh: &ControlMesh, scheme: Scheme, level: u32) -> Result<Self, Error> {
        assert!(level <= MAX_TABLE_LEVEL, "a level that the tessellator reaches");
        let base = Level::from_mesh(mesh)?;
        check_cage(mesh, &base, scheme)?;
        let rules = scheme.rules(mesh.options.triangles);
        let cage = Poly::of_level(&base, mesh.options.creasing);
        let step = Step::new(&cage, rules.as_ref());
        let mut tables = Self::of_step(&base, &step, scheme);
        let builder = Builder {
            rules: rules.as_ref(),
            poly: &step.child,
            creasing: mesh.options.creasing,
            first_point: tables.cage_point_count,
            masks: LimitMasks::default(),
            limits: LimitTable::default(),
            limit_of: vec![NONE; step.child.vertex_sharpness.len()],
            edge_of: vec![(NONE, false); step.child.half_of_edge.len()],
            known: HashMap::new(),
            known_limits: HashMap::new(),
            table: BasisTable { level, ..BasisTable::default() },
        };
        (tables.basis, tables.limits) = builder.build(&base, &cage, scheme);
        Ok(tables)
    }

    /// Points of the cage and of level 1, and where densities are known.
    fn of_step(base: &Level, step: &Step, scheme: Scheme) -> Self {
        let cage_point_count = base.tags.len() as u32;
        let row_count = step.rows.len() as u32;
        let points = cage_point_count..cage_point_count + row_count;
        let child = LevelPoints { points, dispatches: std::iter::once(0..row_count).collect(), edits: 0..0 };
        let mut slots = DensitySlots::new(base, &[]);
        let mut faces = ptex_faces(base);
        if scheme != Scheme::CatmullClark {
            // Triangles are no parts of anything: densities are those of vertices alone.
            slots = slots.of_vertices(cage_point_count);
            let corners = |face: u32| {
                let vertices = base.vertices(face);
                std::array::from_fn(|i| vertices[i.min(vertices.len() - 1)])
            };
            faces = (0..base.face_count()).map(corners).collect();
        }
        Self {
            cage_point_count,
            levels: vec![LevelPoints { points: 0..cage_point_count, ..LevelPoints::default() }, child],
            stencils: stencils(&step.rows),
            patch_ranges: vec![0..0; 2],
            irregular_ranges: vec![0..0; 2],
            ptex_faces: faces,
            slots,
            last_level: 1,
            ..Self::default()
        }
    }
}

fn check_cage(mesh: &ControlMesh, base: &Level, scheme: Scheme) -> Result<(), Error> {
    if !mesh.edits.is_empty() {
        return Err(Error::EditedTable);
    }
    if let Some((face, sides)) = (0..).zip(&mesh.face_sizes).find(|(_, sides)| !scheme.accepts(**sides)) {
        return Err(Error::SchemeFace { scheme: scheme.name(), face, sides: *sides, accepted: scheme.accepted() });
    }
    if let Some(vertex) = base.tags.iter().position(|tag| tag.is_non_manifold()) {
        return Err(Error::NonManifoldTable { vertex: vertex as u32 });
    }
    Ok(())
}

fn stencils(rows: &[Option<Vec<(u32, f64)>>]) -> StencilTable {
    let mut table = StencilTable::default();
    for row in rows {
        let mut row = row.clone().expect("a whole mesh");
        // The largest weight is the origin's, which what the others round to falls to.
        let largest = (0..row.len()).max_by(|&a, &b| row[a].1.total_cmp(&row[b].1)).unwrap_or(0);
        row.swap(0, largest);
        let (first_index, first_weight) = (table.indices.len() as u32, table.weights.len() as u32);
        table.rows.push(StencilRow { first_index, first_weight, count: row.len() as u32 });
        table.indices.extend(row.iter().map(|&(point, _)| point));
        table.weights.extend(row.iter().map(|&(_, weight)| weight as f32));
    }
    table
}

/// A configuration's table, where it lies among all weights.
struct Known {
    /// Places of its controls in the walk.
    controls: Vec<u32>,
    first_weight: u32,
}

struct Builder<'a> {
    rules: &'a dyn Rules,
    /// Level 1.
    poly: &'a Poly,
    creasing: Creasing,
    /// Where its points begin.
    first_point: u32,
    masks: LimitMasks,
    limits: LimitTable,
    /// Limit point of each vertex.
    limit_of: Vec<u32>,
    /// Table edge of each edge, and whether it runs as the edge's first half-edge does.
    edge_of: Vec<(u32, bool)>,
    known: HashMap<(bool, Vec<u32>), Known>,
    known_limits: HashMap<Vec<u32>, u32>,
    table: BasisTable,
}

impl Builder<'_> {
    fn build(mut self, base: &Level, cage: &Poly, scheme: Scheme) -> (BasisTable, LimitTable) {
        let (mut child, mut ptex_face) = (0, 0);
        for face in 0..cage.face_count() {
            let sides = cage.sides(face);
            let in_triangles = self.rules.splits_in_triangles(sides);
            let count = if in_triangles { 4 } else { sides };
            let is_one_ptex_face = sides == 4 || scheme.is_triangle(sides);
            for i in 0..if base.is_drawn(face) { count } else { 0 } {
                let uvs = if in_triangles {
                    TRIANGLE_UVS[i as usize]
                } else if is_one_ptex_face {
                    quad_uvs(i)
                } else {
                    [[0, 0], [2, 0], [2, 2], [0, 2]]
                };
                let ptex_face = ptex_face + if is_one_ptex_face { 0 } else { i };
                self.add_patch(child + i, ptex_face, uvs);
            }
            child += count;
            ptex_face += if is_one_ptex_face { 1 } else { sides };
        }
        (self.table, self.limits)
    }

    fn add_patch(&mut self, face: u32, ptex_face: u32, uvs: [[u32; 2]; 4]) {
        let poly = self.poly;
        let sides = poly.sides(face);
        let faces = poly.ring(&[face], poly.width(self.rules));
        // Of the turns of a face that one whose word is the least stands for all.
        let turns = poly.half_edges(face).map(|h| walk(poly, h, &faces, &[]));
        let (turn, walk) = (0..).zip(turns).min_by(|(_, a), (_, b)| a.word.cmp(&b.word)).expect("a face has edges");
        let (first_weight, first_control, control_count) = self.table_of(&walk, Extent::Face);
        let mut patch = BasisPatch { first_control, control_count, first_weight, ptex_face, ..BasisPatch::default() };
        if sides == 3 {
            patch.flags |= TABLE_TRIANGLE;
        }
        let first = poly.half_edges(face).start;
        for i in 0..sides {
            let h = first + (turn + i) % sides;
            let (limit, is_smooth) = self.limit(poly.origin(h));
            patch.corners[i as usize] = limit;
            let (edge, is_along) = self.edge(poly.edge[h as usize]);
            let is_first = poly.half_of_edge[poly.edge[h as usize] as usize] == h;
            patch.edges[i as usize] = 2 * edge + u32::from(is_along != is_first);
            let is_crease = poly.twin(h) != BORDER && poly.sharpness(h) >= INFINITE_SHARPNESS;
            patch.flags |= u32::from(is_crease) << i | u32::from(!is_smooth) << (4 + i);
            let [u, v] = uvs[((turn + i) % sides) as usize];
            patch.corner_uvs |= (u | v << 2) << (4 * i);
        }
        if sides == 3 {
            patch.corners[3] = patch.corners[0];
        }
        self.table.patches.push(patch);
    }

    /// Where the table of a piece lies, and its controls.
    fn table_of(&mut self, walk: &Walk, extent: Extent) -> (u32, u32, u32) {
        let key = (extent == Extent::Edge, walk.word.clone());
        if !self.known.contains_key(&key) {
            let level = self.table.level;
            let made = grid_table(self.rules, walk, self.creasing, extent, level, &mut self.masks);
            let first_weight = self.append(&made);
            self.known.insert(key.clone(), Known { controls: made.controls, first_weight });
        }
        let known = &self.known[&key];
        let first_control = self.table.controls.len() as u32;
        let point = |&control: &u32| self.first_point + walk.vertices[control as usize];
        self.table.controls.extend(known.controls.iter().map(point));
        (known.first_weight, first_control, known.controls.len() as u32)
    }

    fn append(&mut self, made: &GridTable) -> u32 {
        let first = self.table.weights.len() as u32;
        self.table.weights.extend(made.positions.iter().map(|&weight| weight as f32));
        self.table.tangents.extend(made.tangents.iter().map(|tangents| tangents.map(|weight| weight as f32)));
        first
    }

    /// The table of an edge, and whether it runs as its first half-edge does.
    fn edge(&mut self, edge: u32) -> (u32, bool) {
        if self.edge_of[edge as usize].0 != NONE {
            return self.edge_of[edge as usize];
        }
        let poly = self.poly;
        let h = poly.half_of_edge[edge as usize];
        let faces = poly.faces_at([poly.origin(h), poly.head(h)]);
        let faces = poly.ring(&faces, poly.width(self.rules) - 1);
        let mut chosen = (walk(poly, h, &faces, &[]), true);
        if poly.twin(h) < CUT {
            let back = walk(poly, poly.twin(h), &faces, &[]);
            if back.word < chosen.0.word {
                chosen = (back, false);
            }
        }
        let (first_weight, first_control, control_count) = self.table_of(&chosen.0, Extent::Edge);
        let found = (self.table.edges.len() as u32, chosen.1);
        self.table.edges.push(BasisEdge { first_control, control_count, first_weight });
        self.edge_of[edge as usize] = found;
        found
    }

    /// The limit point of a vertex, and whether the surface has one side there.
    fn limit(&mut self, vertex: u32) -> (u32, bool) {
        let poly = self.poly;
        let fan = poly.fan(vertex, None);
        let sector = Sector::new(poly, &fan, 0);
        let is_smooth = sector.count == 1;
        if self.limit_of[vertex as usize] != NONE {
            return (self.limit_of[vertex as usize], is_smooth);
        }
        let whole = Sector { count: 1, first: fan.spokes[0], faces: fan.spokes.len(), is_closed: fan.is_closed };
        let piece = around(poly, &fan, &whole, poly.width(self.rules));
        let mask = self.masks.of(self.rules, &piece, self.creasing);
        let weights = (0..piece.vertices.len()).map(|i| [mask.position[i], mask.tangents[0][i], mask.tangents[1][i]]);
        let weights: Vec<[f32; 3]> = weights.map(|w| w.map(|weight| weight as f32)).collect();
        let next = self.limits.weights.len() as u32;
        let first_weight = *self.known_limits.entry(piece.word.clone()).or_insert(next);
        if first_weight == next {
            self.limits.weights.extend(weights);
        }
        let first_index = self.limits.indices.len() as u32;
        self.limits.indices.extend(piece.vertices.iter().map(|&vertex| self.first_point + vertex));
        let limit = self.limits.rows.len() as u32;
        self.limits.rows.push(StencilRow { first_index, first_weight, count: piece.vertices.len() as u32 });
        self.limit_of[vertex as usize] = limit;
        (limit, is_smooth)
    }
}

/// Corners of a triangle's four, in halves of its sides: those at its corners, from there on, and the middle one.
const TRIANGLE_UVS: [[[u32; 2]; 4]; 4] = [
    [[0, 0], [1, 0], [0, 1], [0, 0]],
    [[2, 0], [1, 1], [1, 0], [2, 0]],
    [[0, 2], [0, 1], [1, 1], [0, 2]],
    [[1, 0], [1, 1], [0, 1], [1, 0]],
];

/// Corners of the quarter of a quad at its corner i, from there on, in halves.
fn quad_uvs(i: u32) -> [[u32; 2]; 4] {
    const CORNERS: [[u32; 2]; 4] = [[0, 0], [2, 0], [2, 2], [0, 2]];
    let at = |i: u32| CORNERS[(i % 4) as usize];
    let middle = |i: u32| {
        let (a, b) = (at(i), at(i + 1));
        [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
    };
    [at(i), middle(i), [1, 1], middle(i + 3)]
}
