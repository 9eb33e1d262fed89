//! One step of a scheme: the children of a mesh and the rows that make their points.

use crate::basis::poly::{CUT, Fan, Poly};
use crate::rules::{VertexBlend, VertexRule, edge_crease_weight, less_sharp};
use crate::scheme::{Row, Rules};

/// A mesh split once.
pub(crate) struct Step {
    /// The children.
    pub child: Poly,
    /// For each of their vertices its row; none where it lies beyond what the piece can tell.
    pub rows: Vec<Option<Row>>,
}

impl Step {
    pub fn new(poly: &Poly, rules: &dyn Rules) -> Self {
        let vertices = 0..poly.vertex_sharpness.len() as u32;
        let edges = 0..poly.half_of_edge.len() as u32;
        let faces = (0..poly.face_count()).filter(|&face| !rules.splits_in_triangles(poly.sides(face)));
        let rows = vertices
            .map(|vertex| vertex_row(poly, rules, vertex))
            .chain(edges.map(|edge| edge_row(poly, rules, edge)))
            .chain(faces.map(|face| Some(rules.face(poly, face))))
            .map(|row| row.map(summed));
        Self { rows: rows.collect(), child: poly.split(|sides| rules.splits_in_triangles(sides)) }
    }
}

/// Each point once, in ascending order, without weights that are 0.
pub(crate) fn summed(mut row: Row) -> Row {
    row.sort_by_key(|&(vertex, _)| vertex);
    row.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        if is_same {
            kept.1 += next.1;
        }
        is_same
    });
    row.retain(|&(_, weight)| weight != 0.0);
    row
}

fn scaled(row: Row, factor: f64) -> impl Iterator<Item = (u32, f64)> {
    row.into_iter().map(move |(vertex, weight)| (vertex, factor * weight))
}

fn edge_row(poly: &Poly, rules: &dyn Rules, edge: u32) -> Option<Row> {
    let h = poly.half_of_edge[edge as usize];
    if poly.twin(h) == CUT {
        return None;
    }
    let sharpness = poly.edge_sharpness[edge as usize];
    let crease = edge_crease_weight(sharpness, poly.children_sharpness(edge));
    let mut row = Row::new();
    if crease != 0.0 {
        row.extend(scaled(rules.crease_edge(poly, h)?, crease));
    }
    if crease != 1.0 {
        row.extend(scaled(rules.smooth_edge(poly, h)?, 1.0 - crease));
    }
    Some(row)
}

fn vertex_row(poly: &Poly, rules: &dyn Rules, vertex: u32) -> Option<Row> {
    if rules.interpolates() {
        return Some(vec![(vertex, 1.0)]);
    }
    if !poly.is_whole[vertex as usize] {
        return None;
    }
    let fan = poly.fan(vertex, None);
    if fan.edges.is_empty() {
        return Some(vec![(vertex, 1.0)]);
    }
    let sharpness = poly.vertex_sharpness[vertex as usize];
    let before: Vec<f32> = fan.edges.iter().map(|&edge| poly.edge_sharpness[edge as usize]).collect();
    let after: Vec<f32> = fan.edges.iter().map(|&edge| child_at(poly, edge, vertex)).collect();
    let blend = VertexBlend::new([sharpness, less_sharp(sharpness)], [&before, &after]);
    let mut row = Row::new();
    for ((rule, ends), weight) in [(blend.before, blend.weight), (blend.after, 1.0 - blend.weight)] {
        if weight != 0.0 {
            row.extend(scaled(rule_row(poly, rules, vertex, &fan, rule, ends)?, weight));
        }
    }
    Some(row)
}

/// Sharpness of the child of an edge at one of its ends.
fn child_at(poly: &Poly, edge: u32, vertex: u32) -> f32 {
    let [at_origin, at_head] = poly.children_sharpness(edge);
    if poly.origin(poly.half_of_edge[edge as usize]) == vertex { at_origin } else { at_head }
}

fn rule_row(poly: &Poly, rules: &dyn Rules, vertex: u32, fan: &Fan, rule: VertexRule, ends: [usize; 2]) -> Option<Row> {
    match rule {
        VertexRule::Smooth | VertexRule::Dart => rules.smooth_vertex(poly, vertex, fan),
        VertexRule::Crease => Some(rules.crease_vertex(vertex, ends.map(|end| fan.ends[end]))),
        VertexRule::Corner => Some(vec![(vertex, 1.0)]),
    }
}
