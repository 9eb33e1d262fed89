//! The tables of a cage: which configurations its faces, edges and vertices have after one step, and each one's weights once.

use std::collections::HashMap;

use crate::basis::cache::{BasisCache, BasisCounts, NoCache, Rulebook};
use crate::basis::grid::Extent;
use crate::basis::limit::{Sector, around};
use crate::basis::poly::{BORDER, CUT, Poly};
use crate::basis::source::TableSource;
use crate::basis::step::Step;
use crate::basis::walk::{Walk, walk};
use crate::error::Error;
use crate::limit::LimitTable;
use crate::mesh::{ControlMesh, INFINITE_SHARPNESS};
use crate::scheme::{Rules, Scheme};
use crate::stencil::{StencilRow, StencilTable};
use crate::tables::slots::ptex_faces;
use crate::tables::{BasisEdge, BasisPatch, BasisTable, DensitySlots, LevelPoints, TABLE_TRIANGLE, Tables};
use crate::topology::{Level, NONE};

/// The tessellator makes 64 segments at most.
pub const MAX_TABLE_LEVEL: u32 = 6;

/// What to make of a cage for the method `table`, or for substitutes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BasisOptions {
    /// Subdivision scheme.
    pub scheme: Scheme,
    /// How often the cage is split first: 1, or 2; 0 for substitutes.
    pub steps: u32,
    /// Basis functions of 2^`level` segments a side.
    pub level: u32,
    /// Level whose rings of vertices are asked for, if any: what geometric normals are made of.
    pub ring_level: Option<u32>,
    /// Points are weighed: else patches have their corners for controls, and no weights.
    pub has_weights: bool,
}

/// How often a cage is split at most before tables take over.
pub const MAX_TABLE_STEPS: u32 = 2;

/// A face of a level: whose surface is drawn, and where it lies.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    is_drawn: bool,
    ptex_face: u32,
    /// Parameters of its corners on the Ptex face, in 2^-level.
    uvs: [[u32; 2]; 4],
}

impl Tables {
    /// Tables of a cage for the method `table`: its steps, limit points of the last one, and basis functions over that one's faces.
    ///
    /// # Errors
    /// When the scheme does not take the cage: other faces than it knows, edges or vertices that are not manifold, hierarchical edits.
    ///
    /// # Panics
    /// If `level` is above [`MAX_TABLE_LEVEL`], or `steps` above [`MAX_TABLE_STEPS`].
    pub fn of_basis(mesh: &ControlMesh, options: &BasisOptions) -> Result<Self, Error> {
        Ok(Self::of_basis_cached(mesh, options, &NoCache)?.0)
    }

    /// As [`Self::of_basis`], the same bits, with what a cache has; what it has not is stored there.
    ///
    /// # Errors
    /// As [`Self::of_basis`].
    ///
    /// # Panics
    /// As [`Self::of_basis`].
    pub fn of_basis_cached(
        mesh: &ControlMesh,
        options: &BasisOptions,
        cache: &dyn BasisCache,
    ) -> Result<(Self, BasisCounts), Error> {
        let &BasisOptions { scheme, steps, level, ring_level, has_weights } = options;
        assert!(level <= MAX_TABLE_LEVEL && steps <= MAX_TABLE_STEPS, "a level that the tessellator reaches");
        let base = Level::from_mesh(mesh)?;
        check_cage(mesh, &base, scheme)?;
        let rulebook = Rulebook { scheme, triangles: mesh.options.triangles, creasing: mesh.options.creasing };
        let rules = scheme.rules(rulebook.triangles);
        let mut poly = Poly::of_level(&base, mesh.options.creasing);
        let mut places = base_places(&base, scheme);
        let mut tables = Self::of_cage(&base, scheme, steps);
        let mut rings = Vec::new();
        for step in 0..=steps {
            if ring_level == Some(step) {
                rings = fans(&poly, tables.levels[step as usize].points.start);
            }
            if step < steps {
                places = child_places(&poly, &places, rules.as_ref());
                let split = Step::new(&poly, rules.as_ref());
                tables.add_step(&split.rows);
                poly = split.child;
            }
        }
        let builder = Builder {
            rules: rules.as_ref(),
            poly: &poly,
            first_point: tables.levels[steps as usize].points.start,
            has_weights,
            source: TableSource::new(rules.as_ref(), rulebook, level, cache),
            limits: LimitTable::default(),
            limit_of: vec![NONE; poly.vertex_sharpness.len()],
            edge_of: vec![(NONE, false); poly.half_of_edge.len()],
            known: HashMap::new(),
            known_limits: HashMap::new(),
            table: BasisTable { level, steps, ..BasisTable::default() },
        };
        let counts;
        (tables.basis, tables.limits, counts) = builder.build(&places);
        (tables.basis.ring_level, tables.basis.rings) = (ring_level.unwrap_or(0), rings);
        Ok((tables, counts))
    }

    /// Points of the cage, and where densities are known.
    fn of_cage(base: &Level, scheme: Scheme, steps: u32) -> Self {
        let cage_point_count = base.tags.len() as u32;
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
            levels: vec![LevelPoints { points: 0..cage_point_count, ..LevelPoints::default() }],
            patch_ranges: vec![0..0; steps as usize + 1],
            irregular_ranges: vec![0..0; steps as usize + 1],
            ptex_faces: faces,
            slots,
            last_level: steps,
            ..Self::default()
        }
    }

    /// The points of the next level.
    fn add_step(&mut self, rows: &[Option<Vec<(u32, f64)>>]) {
        let (first_parent, first) = (self.levels[self.levels.len() - 1].points.start, self.point_count());
        let first_row = first - self.cage_point_count;
        let dispatches = std::iter::once(first_row..first_row + rows.len() as u32).collect();
        append_stencils(&mut self.stencils, rows, first_parent);
        self.levels.push(LevelPoints { points: first..first + rows.len() as u32, dispatches, edits: 0..0 });
    }
}

/// The faces of a cage. One that becomes several Ptex faces has parameters first when it is split.
fn base_places(base: &Level, scheme: Scheme) -> Vec<Place> {
    let mut ptex_face = 0;
    let place = |face: u32| {
        let sides = base.sides(face);
        let uvs = if sides == 3 { [[0, 0], [1, 0], [0, 1], [0, 0]] } else { [[0, 0], [1, 0], [1, 1], [0, 1]] };
        let place = Place { is_drawn: base.is_drawn(face), ptex_face, uvs };
        ptex_face += if sides == 4 || scheme.is_triangle(sides) { 1 } else { sides };
        place
    };
    (0..base.face_count()).map(place).collect()
}

/// The children of faces, in their order.
fn child_places(poly: &Poly, places: &[Place], rules: &dyn Rules) -> Vec<Place> {
    let mut children = Vec::new();
    for (face, place) in (0..).zip(places) {
        let sides = poly.sides(face);
        let in_triangles = rules.splits_in_triangles(sides);
        let at = |i: u32| place.uvs[(i % sides) as usize];
        let sum = |a: [u32; 2], b: [u32; 2]| [a[0] + b[0], a[1] + b[1]];
        let corner = |i: u32| at(i).map(|c| 2 * c);
        let middle = |i: u32| sum(at(i), at(i + 1));
        for i in 0..sides {
            let before = i + sides - 1;
            let (ptex_face, uvs) = if in_triangles {
                (place.ptex_face, [corner(i), middle(i), middle(before), corner(i)])
            } else if sides == 4 {
                (place.ptex_face, [corner(i), middle(i), sum(at(0), at(2)), middle(before)])
            } else {
                // A Ptex face for each corner, which is whole.
                (place.ptex_face + i, [[0, 0], [2, 0], [2, 2], [0, 2]])
            };
            children.push(Place { uvs, ptex_face, ..*place });
        }
        if in_triangles {
            children.push(Place { uvs: [middle(0), middle(1), middle(2), middle(0)], ..*place });
        }
    }
    children
}

/// The rings of a level's vertices: the ends of their edges, counter-clockwise.
fn fans(poly: &Poly, first_point: u32) -> Vec<(Vec<u32>, bool)> {
    let ring = |vertex: u32| {
        let fan = poly.fan(vertex, None);
        (fan.ends.iter().map(|&end| first_point + end).collect(), fan.is_closed)
    };
    (0..poly.vertex_sharpness.len() as u32).map(ring).collect()
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

fn append_stencils(table: &mut StencilTable, rows: &[Option<Vec<(u32, f64)>>], first_point: u32) {
    for row in rows {
        let mut row = row.clone().expect("a whole mesh");
        // The largest weight is the origin's, which what the others round to falls to.
        let largest = (0..row.len()).max_by(|&a, &b| row[a].1.total_cmp(&row[b].1)).unwrap_or(0);
        row.swap(0, largest);
        let (first_index, first_weight) = (table.indices.len() as u32, table.weights.len() as u32);
        table.rows.push(StencilRow { first_index, first_weight, count: row.len() as u32 });
        table.indices.extend(row.iter().map(|&(point, _)| first_point + point));
        table.weights.extend(row.iter().map(|&(_, weight)| weight as f32));
    }
}

/// A configuration's table, where it lies among all weights.
struct Known {
    /// Places of its controls in the walk.
    controls: Vec<u32>,
    first_weight: u32,
}

struct Builder<'a> {
    rules: &'a dyn Rules,
    /// The last level.
    poly: &'a Poly,
    /// Where its points begin.
    first_point: u32,
    has_weights: bool,
    source: TableSource<'a>,
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
    fn build(mut self, places: &[Place]) -> (BasisTable, LimitTable, BasisCounts) {
        for (face, place) in (0..).zip(places).filter(|(_, place)| place.is_drawn) {
            if self.has_weights {
                self.add_patch(face, place);
            } else {
                self.add_substitute(face, place);
            }
        }
        (self.table, self.limits, self.source.counts())
    }

    fn add_patch(&mut self, face: u32, place: &Place) {
        let poly = self.poly;
        let sides = poly.sides(face);
        let faces = poly.ring(&[face], poly.width(self.rules));
        // Of the turns of a face that one whose word is the least stands for all.
        let turns = poly.half_edges(face).map(|h| walk(poly, h, &faces, &[]));
        let (turn, walk) = (0..).zip(turns).min_by(|(_, a), (_, b)| a.word.cmp(&b.word)).expect("a face has edges");
        let (first_weight, first_control, control_count) = self.table_of(&walk, Extent::Face);
        let mut patch = BasisPatch { first_control, control_count, first_weight, ..of_place(place, sides, turn) };
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
        }
        if sides == 3 {
            patch.corners[3] = patch.corners[0];
        }
        self.table.patches.push(patch);
    }

    /// A face of which the corners alone are known.
    fn add_substitute(&mut self, face: u32, place: &Place) {
        let vertices = self.poly.vertices(face);
        let first_control = self.table.controls.len() as u32;
        self.table.controls.extend(vertices.iter().map(|&vertex| self.first_point + vertex));
        let sides = vertices.len() as u32;
        self.table.patches.push(BasisPatch { first_control, control_count: sides, ..of_place(place, sides, 0) });
    }

    /// Where the table of a piece lies, and its controls.
    fn table_of(&mut self, walk: &Walk, extent: Extent) -> (u32, u32, u32) {
        let key = (extent == Extent::Edge, walk.word.clone());
        if !self.known.contains_key(&key) {
            let made = self.source.grid(walk, extent);
            let first_weight = self.table.weights.len() as u32;
            self.table.weights.extend(made.positions);
            self.table.tangents.extend(made.tangents);
            self.known.insert(key.clone(), Known { controls: made.controls, first_weight });
        }
        let known = &self.known[&key];
        let first_control = self.table.controls.len() as u32;
        let point = |&control: &u32| self.first_point + walk.vertices[control as usize];
        self.table.controls.extend(known.controls.iter().map(point));
        (known.first_weight, first_control, known.controls.len() as u32)
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
        let next = self.limits.weights.len() as u32;
        let first_weight = *self.known_limits.entry(piece.word.clone()).or_insert(next);
        if first_weight == next {
            self.limits.weights.extend(self.source.limit(&piece));
        }
        let first_index = self.limits.indices.len() as u32;
        self.limits.indices.extend(piece.vertices.iter().map(|&vertex| self.first_point + vertex));
        let limit = self.limits.rows.len() as u32;
        self.limits.rows.push(StencilRow { first_index, first_weight, count: piece.vertices.len() as u32 });
        self.limit_of[vertex as usize] = limit;
        (limit, is_smooth)
    }
}

/// A patch that lies there, beginning at corner `turn`.
fn of_place(place: &Place, sides: u32, turn: u32) -> BasisPatch {
    let uv = |i: u32| place.uvs[((turn + i) % sides) as usize];
    let corner_uvs = (0..sides).fold(0, |uvs, i| uvs | (uv(i)[0] | uv(i)[1] << 3) << (6 * i));
    let flags = if sides == 3 { TABLE_TRIANGLE } else { 0 };
    BasisPatch { ptex_face: place.ptex_face, corner_uvs, flags, ..BasisPatch::default() }
}
