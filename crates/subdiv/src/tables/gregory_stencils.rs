//! Control points of Gregory patches straight from the cage's points: a table of weights for each connectivity (Loop et al. 2009,
//! section 4.3).
//!
//! A table is a matrix: a column for each point of the one-ring, a row for each control point and each vector across an edge. Columns
//! are sorted by what they hold, so that all faces of the same connectivity have the same table however their meshes number points.
//! A face's ring names for each of its points the column; it is sorted by point, so that all patches sum in one order (section 4.5).

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::gregory::{Composer, Form, SectorSpokes, SpokeForms, face_point_weights, sum_forms};
use crate::tables::gregory::{GregoryFace, GregoryKind, Spoke};
use crate::topology::NONE;

/// Rows for each corner: e+, e-, f+ and f- there, then for each edge the four control vectors across it.
pub const ROWS_PER_CORNER: usize = 8;
/// Faces of a larger one-ring keep two stages: around a vertex of valence n are n rings of 2 n points.
pub const MAX_RING_POINTS: usize = 1024;
/// Smaller weights are rounding errors of zeros.
const LEAST_WEIGHT: f64 = 1e-12;
/// Rows of a quad.
const MAX_ROWS: usize = 4 * ROWS_PER_CORNER;

/// The matrix of a connectivity: [`ROWS_PER_CORNER`] rows for each corner, column by column. The value of a row is its origin, the
/// point of the corner that it belongs to, or for a vector 0, plus the sum of weights times points relative to that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connectivity {
    /// Place in [`GregoryStencils::weights`].
    pub first_weight: u32,
    /// Number of columns.
    pub point_count: u32,
    /// 4, or 3.
    pub corner_count: u32,
}

/// How the control points of an irregular face are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilFace {
    /// Place among the connectivities; [`NONE`] if the face's points are made of spokes: parts of faces of more than four sides, faces
    /// at vertices whose edge points are not linear, and those of more than [`MAX_RING_POINTS`].
    pub connectivity: u32,
    /// The points of its corners.
    pub corners: [u32; 4],
    /// Place in [`GregoryStencils::rings`].
    pub first_point: u32,
    /// Edges that are shared with a face that is made of spokes, one bit each: their points are those of the spokes.
    pub spoke_edges: u8,
}

impl StencilFace {
    const OF_SPOKES: Self = Self { connectivity: NONE, corners: [NONE; 4], first_point: 0, spoke_edges: 0 };

    /// Whether its control points are made of spokes.
    pub fn is_of_spokes(&self) -> bool {
        self.connectivity == NONE
    }
}

/// Stencils of Gregory patches.
#[derive(Clone, Debug, Default)]
pub struct GregoryStencils {
    /// As many as irregular faces; none if they were not asked for.
    pub faces: Vec<StencilFace>,
    /// Of each face its points in ascending order, their columns, and a mask of the rows that have a weight there, row i being bit i.
    pub rings: Vec<[u32; 3]>,
    /// The tables.
    pub connectivities: Vec<Connectivity>,
    /// Their weights.
    pub weights: Vec<f32>,
    interned: HashMap<Vec<u32>, u32>,
}

impl GregoryStencils {
    /// Number of the table of these columns, each of `row_count` bit patterns.
    fn intern(&mut self, row_count: usize, columns: Vec<u32>) -> u32 {
        let connectivity = Connectivity {
            first_weight: self.weights.len() as u32,
            point_count: (columns.len() / row_count) as u32,
            corner_count: (row_count / ROWS_PER_CORNER) as u32,
        };
        // The number of rows tells a triangle from a quad of as many weights.
        let key: Vec<u32> = std::iter::once(row_count as u32).chain(columns).collect();
        if let Some(&known) = self.interned.get(&key) {
            return known;
        }
        let place = self.connectivities.len() as u32;
        self.connectivities.push(connectivity);
        self.weights.extend(key[1..].iter().map(|&bits| f32::from_bits(bits)));
        self.interned.insert(key, place);
        place
    }

    /// Appends the rings of another table's faces, whose points follow those here: where they begin, and the new number of each of
    /// the other's tables.
    pub(super) fn append_tables(&mut self, other: &Self, points: &[u32]) -> (u32, Vec<u32>) {
        let first = self.rings.len() as u32;
        self.rings.extend(other.rings.iter().map(|&[point, column, mask]| [points[point as usize], column, mask]));
        let places = other.connectivities.iter().map(|table| {
            let row_count = table.corner_count as usize * ROWS_PER_CORNER;
            let weights = &other.weights[table.first_weight as usize..][..row_count * table.point_count as usize];
            self.intern(row_count, weights.iter().map(|weight| weight.to_bits()).collect())
        });
        (first, places.collect())
    }

    /// Appends faces of that table.
    pub(super) fn append_faces(&mut self, faces: &[StencilFace], first_point: u32, places: &[u32], points: &[u32]) {
        let moved = |entry: u32, to: &[u32]| to.get(entry as usize).copied().unwrap_or(NONE);
        self.faces.extend(faces.iter().map(|face| StencilFace {
            connectivity: moved(face.connectivity, places),
            corners: face.corners.map(|corner| moved(corner, points)),
            first_point: face.first_point + first_point,
            ..*face
        }));
    }
}

/// Fills the table as limit points and faces come.
pub(super) struct StencilBuilder<'a> {
    composer: Composer<'a>,
    limits: Vec<SpokeForms>,
    /// By spoke: its limit point's place among `limits`, and its own among the spokes there.
    places: Vec<[u32; 2]>,
    table: GregoryStencils,
    /// First spokes of the triangle that was added last, of which all thirds have the same points.
    triangle: [u32; 4],
}

impl<'a> StencilBuilder<'a> {
    pub fn new(composer: Composer<'a>) -> Self {
        let table = GregoryStencils::default();
        Self { composer, limits: Vec::new(), places: Vec::new(), table, triangle: [NONE; 4] }
    }

    /// Adds the spokes of a limit point, which follow those that are there; see [`SpokeForms::new`].
    pub fn push_limit(&mut self, spokes: &SectorSpokes, origin: u32, first_point: u32, mask: &[(u32, [f64; 3])]) {
        let limit = self.limits.len() as u32;
        self.limits.push(SpokeForms::new(&mut self.composer, spokes, origin, first_point, mask));
        self.places.extend((0..spokes.weights.len() as u32).map(|spoke| [limit, spoke]));
    }

    /// Adds a face that is not drawn, or of spokes.
    pub fn push_of_spokes(&mut self, count: u32) {
        self.table.faces.extend(std::iter::repeat_n(StencilFace::OF_SPOKES, count as usize));
    }

    /// Adds a face; all its spokes are there.
    pub fn push_face(&mut self, face: &GregoryFace, spokes: &[Spoke]) {
        let made = match face.kind {
            GregoryKind::Quad => self.face::<4>(face, spokes),
            GregoryKind::PartOfTriangle(_) if self.triangle == face.first => self.table.faces.last().copied(),
            GregoryKind::PartOfTriangle(_) => self.face::<3>(face, spokes),
            GregoryKind::PartOfNgon | GregoryKind::None => None,
        };
        self.triangle = if matches!(face.kind, GregoryKind::PartOfTriangle(_)) { face.first } else { [NONE; 4] };
        self.table.faces.push(made.unwrap_or(StencilFace::OF_SPOKES));
    }

    /// The table; `origins` are the points of the spokes' own vertices.
    pub fn finish(mut self, faces: &[GregoryFace], spokes: &[Spoke], origins: impl Fn(u32) -> u32) -> GregoryStencils {
        let ends = |spoke: u32| {
            let (own, end) = (origins(spoke), spokes[spoke as usize].end);
            [own.min(end), own.max(end)]
        };
        let of_spokes = faces.iter().zip(&self.table.faces).filter(|(_, stencil)| stencil.is_of_spokes());
        let edges: HashSet<[u32; 2]> = of_spokes.flat_map(|(face, _)| face.cage_edges().map(ends)).collect();
        for (face, stencil) in faces.iter().zip(&mut self.table.faces).filter(|(_, stencil)| !stencil.is_of_spokes()) {
            let shared = |mask: u8, (i, spoke): (u32, u32)| mask | u8::from(edges.contains(&ends(spoke))) << i;
            stencil.spoke_edges = (0..).zip(face.cage_edges()).fold(0, shared);
        }
        self.table
    }

    fn limit(&self, spoke: u32) -> (&SpokeForms, usize) {
        let [limit, place] = self.places[spoke as usize];
        (&self.limits[limit as usize], place as usize)
    }

    fn edge(&self, spoke: u32) -> Option<&Form> {
        let (limit, place) = self.limit(spoke);
        Some(&limit.edges.as_ref()?[place])
    }

    fn beside(&self, spoke: u32) -> &Form {
        let (limit, place) = self.limit(spoke);
        &limit.besides[place]
    }

    /// The vector across, times a sign.
    fn across(&self, spoke: u32, sign: f64, spokes: &[Spoke]) -> Option<Form> {
        let [before, after] = spokes[spoke as usize].neighbours;
        if before == NONE || after == NONE {
            return Some(Form::new());
        }
        Some(sum_forms(&[(1.5 * sign, self.edge(after)?), (-1.5 * sign, self.edge(before)?)]))
    }

    fn face<const N: usize>(&mut self, face: &GregoryFace, spokes: &[Spoke]) -> Option<StencilFace> {
        let mut columns = Columns { rows: 0, of_point: BTreeMap::new() };
        let mut corners = [NONE; 4];
        for (i, corner) in corners.iter_mut().enumerate().take(N) {
            let (own, _) = self.limit(face.first[i]);
            *corner = own.origin;
            let (next, previous) = ((i + 1) % N, (i + N - 1) % N);
            let (out, into) = (face.first[i], face.last[previous]);
            columns.push(own.origin, self.edge(out)?);
            columns.push(own.origin, self.edge(into)?);
            for (spoke, far, far_seat, sign) in
                [(out, face.last[i], next, 1.0), (into, face.first[previous], previous, -1.0)]
            {
                let degree = if N == 3 { 4.0 } else { 3.0 };
                let [own_cosine, far_cosine] = [i, far_seat].map(|seat| f64::from(face.cosines[seat]));
                let [of_corner, of_edge, of_far, of_r] = face_point_weights(degree, own_cosine, far_cosine);
                let point = sum_forms(&[
                    (of_corner, &own.position),
                    (of_edge, self.edge(spoke)?),
                    (of_far, self.edge(far)?),
                    (sign * of_r, self.beside(spoke)),
                ]);
                columns.push(own.origin, &point);
            }
        }
        for i in 0..N {
            let ((from, _), (to, _)) = (self.limit(face.first[i]), self.limit(face.last[i]));
            columns.push(from.origin, &self.across(face.first[i], 1.0, spokes)?);
            columns.push(from.origin, self.beside(face.first[i]));
            columns.push(to.origin, &sum_forms(&[(-1.0, self.beside(face.last[i]))]));
            columns.push(to.origin, &self.across(face.last[i], -1.0, spokes)?);
        }
        if columns.of_point.len() > MAX_RING_POINTS {
            return None;
        }
        let first_point = self.table.rings.len() as u32;
        let connectivity = columns.append_to(&mut self.table);
        Some(StencilFace { connectivity, corners, first_point, spoke_edges: 0 })
    }
}

/// A matrix as its rows come.
struct Columns {
    rows: usize,
    /// The bits of the weights of each point.
    of_point: BTreeMap<u32, [u32; MAX_ROWS]>,
}

impl Columns {
    /// Adds a row; what it is relative to has no weight.
    fn push(&mut self, origin: u32, form: &[(u32, f64)]) {
        for &(point, weight) in form.iter().filter(|(point, weight)| *point != origin && weight.abs() > LEAST_WEIGHT) {
            self.of_point.entry(point).or_insert([0; MAX_ROWS])[self.rows] = (weight as f32).to_bits();
        }
        self.rows += 1;
    }

    /// Appends the ring, and the matrix if there is none like it; the number of that.
    fn append_to(self, table: &mut GregoryStencils) -> u32 {
        let mut sorted: Vec<(&[u32; MAX_ROWS], u32)> =
            self.of_point.iter().map(|(&point, column)| (column, point)).collect();
        sorted.sort_unstable();
        let mask = |weights: &[u32; MAX_ROWS]| {
            (0..MAX_ROWS).fold(0_u32, |mask, row| mask | u32::from(weights[row] != 0) << row)
        };
        let mut ring: Vec<[u32; 3]> =
            (0..).zip(&sorted).map(|(column, &(weights, point))| [point, column, mask(weights)]).collect();
        ring.sort_unstable();
        table.rings.extend(ring);
        table.intern(self.rows, sorted.iter().flat_map(|(column, _)| column[..self.rows].iter().copied()).collect())
    }
}
