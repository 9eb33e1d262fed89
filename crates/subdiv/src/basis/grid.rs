//! Tables of one configuration: a face, or an edge, with all that it depends on is split again and again with the identity as
//! values, and the points of its grid are taken to the limit (Bolz and Schroeder 2002; Hollaender and Boubekeur 2010, section II.A).

use std::collections::HashMap;

use crate::basis::limit::{LimitMasks, Sector, around};
use crate::basis::poly::Poly;
use crate::basis::step::Step;
use crate::basis::walk::Walk;
use crate::mesh::Creasing;
use crate::scheme::Rules;

/// Which points a table has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// All of the first face: row by row from its first edge on.
    Face,
    /// Those of its first edge.
    Edge,
}

/// Rows of a table: for each point weights of the controls that have any.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct GridTable {
    /// Places of the controls in the walk, the first vertex first.
    pub controls: Vec<u32>,
    /// Weights of positions: `controls` a row.
    pub positions: Vec<f32>,
    /// Weights of two tangents whose cross product points outward.
    pub tangents: Vec<[f32; 2]>,
}

/// A piece while it is split: what is left of it, and where its points lie in the grid.
struct Piece<'a> {
    rules: &'a dyn Rules,
    extent: Extent,
    poly: Poly,
    /// Of each vertex: weights of the walk's vertices.
    values: Vec<Vec<f64>>,
    /// Faces of the grid.
    central: Vec<u32>,
    /// Places in the grid of their vertices.
    places: HashMap<u32, [u32; 2]>,
}

/// The table of a piece, of which the first face is asked for, or its first edge.
pub(crate) fn grid_table(
    rules: &dyn Rules,
    walk: &Walk,
    creasing: Creasing,
    extent: Extent,
    level: u32,
    masks: &mut LimitMasks,
) -> GridTable {
    let poly = walk.poly(creasing);
    let count = walk.vertices.len();
    let corners: &[[u32; 2]] =
        if poly.sides(0) == 3 { &[[0, 0], [1, 0], [0, 1]] } else { &[[0, 0], [1, 0], [1, 1], [0, 1]] };
    let mut piece = Piece {
        rules,
        extent,
        values: (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect(),
        central: vec![0],
        places: poly.vertices(0).iter().copied().zip(corners.iter().copied()).collect(),
        poly,
    };
    for _ in 0..level {
        piece.split();
    }
    piece.table(count, masks)
}

impl Piece<'_> {
    fn split(&mut self) {
        let step = Step::new(&self.poly, self.rules);
        let places = self.child_places();
        let child_faces = self.children_of_central();
        let is_asked =
            |vertex: &u32| places.get(vertex).is_some_and(|place| self.extent == Extent::Face || place[1] == 0);
        let central: Vec<u32> = match self.extent {
            Extent::Face => child_faces,
            Extent::Edge => child_faces
                .into_iter()
                .filter(|&face| step.child.vertices(face).iter().filter(|vertex| is_asked(vertex)).count() > 1)
                .collect(),
        };
        let asked: Vec<u32> = central
            .iter()
            .flat_map(|&face| step.child.vertices(face))
            .copied()
            .filter(|vertex| is_asked(vertex))
            .collect();
        let mut kept = step.child.faces_at(asked);
        kept = step.child.ring(&kept, self.poly.width(self.rules) - 1);
        // What lies too far out is not known, and not needed.
        kept.retain(|&face| step.child.vertices(face).iter().all(|&vertex| step.rows[vertex as usize].is_some()));
        let (poly, vertices) = step.child.piece(&kept);
        let values = vertices.iter().map(|&vertex| {
            let row = step.rows[vertex as usize].as_deref().unwrap_or_default();
            let mut sum = vec![0.0; self.values[0].len()];
            for &(point, weight) in row {
                sum.iter_mut().zip(&self.values[point as usize]).for_each(|(sum, value)| *sum += weight * value);
            }
            sum
        });
        self.values = values.collect();
        let number: HashMap<u32, u32> = vertices.iter().copied().zip(0..).collect();
        let face_number: HashMap<u32, u32> = kept.iter().copied().zip(0..).collect();
        self.central = central.iter().map(|face| face_number[face]).collect();
        self.central.sort_unstable();
        self.places = places.iter().filter_map(|(vertex, place)| Some((*number.get(vertex)?, *place))).collect();
        self.poly = poly;
    }

    /// Places of the children's vertices in a grid of twice the points.
    fn child_places(&self) -> HashMap<u32, [u32; 2]> {
        let poly = &self.poly;
        let (vertex_count, edge_count) = (poly.vertex_sharpness.len() as u32, poly.half_of_edge.len() as u32);
        let mut places: HashMap<u32, [u32; 2]> =
            self.places.iter().map(|(&vertex, place)| (vertex, place.map(|at| 2 * at))).collect();
        let sum = |vertices: &[u32]| {
            vertices.iter().fold([0, 0], |sum, vertex| {
                let place = self.places[vertex];
                [sum[0] + place[0], sum[1] + place[1]]
            })
        };
        let mut face_point = vertex_count + edge_count;
        let mut point_of_face = HashMap::new();
        for face in 0..poly.face_count() {
            if !self.rules.splits_in_triangles(poly.sides(face)) {
                point_of_face.insert(face, face_point);
                face_point += 1;
            }
        }
        for &face in &self.central {
            for h in poly.half_edges(face) {
                places.insert(vertex_count + poly.edge[h as usize], sum(&[poly.origin(h), poly.head(h)]));
            }
            if let Some(&point) = point_of_face.get(&face) {
                places.insert(point, sum(poly.vertices(face)).map(|at| at / 2));
            }
        }
        places
    }

    fn children_of_central(&self) -> Vec<u32> {
        let poly = &self.poly;
        let child_count = |face: u32| {
            if self.rules.splits_in_triangles(poly.sides(face)) { 4 } else { poly.sides(face) }
        };
        let mut first = Vec::with_capacity(poly.face_count() as usize);
        let mut next = 0;
        for face in 0..poly.face_count() {
            first.push(next);
            next += child_count(face);
        }
        self.central.iter().flat_map(|&face| first[face as usize]..first[face as usize] + child_count(face)).collect()
    }

    fn table(&self, count: usize, masks: &mut LimitMasks) -> GridTable {
        let mut points: Vec<([u32; 2], u32)> =
            self.places.iter().map(|(&vertex, &place)| ([place[1], place[0]], vertex)).collect();
        points.retain(|(place, _)| self.extent == Extent::Face || place[0] == 0);
        points.sort_unstable();
        let rows: Vec<(Vec<f64>, Vec<[f64; 2]>)> =
            points.iter().map(|&(_, vertex)| self.limit(vertex, masks)).collect();
        let has_weight = |&control: &usize| {
            control == 0
                || rows.iter().any(|(position, tangents)| position[control] != 0.0 || tangents[control] != [0.0; 2])
        };
        let controls: Vec<usize> = (0..count).filter(has_weight).collect();
        let mut table =
            GridTable { controls: controls.iter().map(|&control| control as u32).collect(), ..GridTable::default() };
        for (position, tangents) in &rows {
            table.positions.extend(controls.iter().map(|&control| position[control] as f32));
            table.tangents.extend(controls.iter().map(|&control| tangents[control].map(|weight| weight as f32)));
        }
        table
    }

    /// The limit of a vertex: of the grid's face, where the surface has several sides there.
    fn limit(&self, vertex: u32, masks: &mut LimitMasks) -> (Vec<f64>, Vec<[f64; 2]>) {
        let poly = &self.poly;
        assert!(poly.is_whole[vertex as usize], "all that a point of the grid depends on");
        let fan = poly.fan(vertex, None);
        let face = fan
            .spokes
            .iter()
            .position(|&spoke| self.central.binary_search(&poly.face[spoke as usize]).is_ok())
            .unwrap_or(0);
        let own = Sector::new(poly, &fan, face);
        let piece = around(poly, &fan, &own, poly.width(self.rules));
        let mask = masks.of(self.rules, &piece, poly.creasing);
        let tangents = self.weighed(&piece, &mask.tangents[0]).into_iter().zip(self.weighed(&piece, &mask.tangents[1]));
        let tangents: Vec<[f64; 2]> = tangents.map(|(a, b)| [a, b]).collect();
        if own.count == 1 {
            return (self.weighed(&piece, &mask.position), tangents);
        }
        let whole = Sector { count: 1, first: fan.spokes[0], faces: fan.spokes.len(), is_closed: fan.is_closed };
        let piece = around(poly, &fan, &whole, poly.width(self.rules));
        (self.weighed(&piece, &masks.of(self.rules, &piece, poly.creasing).position), tangents)
    }

    fn weighed(&self, piece: &Walk, weights: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.values[0].len()];
        for (&vertex, weight) in piece.vertices.iter().zip(weights) {
            sum.iter_mut().zip(&self.values[vertex as usize]).for_each(|(sum, value)| *sum += weight * value);
        }
        sum
    }
}
