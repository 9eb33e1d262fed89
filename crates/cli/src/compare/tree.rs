//! The nearest point on a soup, by a tree of boxes.

use glam::{DVec3, Vec3};

use super::soup::Triangle;

/// Triangles of a leaf at most.
const LEAF_LENGTH: usize = 4;

/// Halves by the number of triangles, along the longest side of the box around their middles.
pub struct Tree<'a> {
    triangles: &'a [Triangle],
    /// Indices of triangles; those of a node are consecutive.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    low: Vec3,
    high: Vec3,
    /// Of a leaf, where its triangles begin in the order; of another, its second child. The first is the next node.
    next: u32,
    /// Triangles of a leaf, 0 of another.
    length: u32,
}

/// A point on a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<'a> {
    pub triangle: &'a Triangle,
    /// Barycentric coordinates.
    pub weights: [f64; 3],
    pub distance_squared: f64,
}

impl<'a> Tree<'a> {
    /// Of fewer than 2^31 triangles; a dump has no more.
    pub fn new(triangles: &'a [Triangle]) -> Self {
        let middles: Vec<Vec3> =
            triangles.iter().map(|t| t.corners.map(|corner| corner.position).iter().sum()).collect();
        let mut order: Vec<u32> = (0..).take(triangles.len()).collect();
        let mut nodes = Vec::new();
        if !order.is_empty() {
            split(triangles, &middles, &mut order, 0, &mut nodes);
        }
        Self { triangles, order, nodes }
    }

    /// The nearest point; none in an empty soup.
    pub fn nearest(&self, point: DVec3) -> Option<Nearest<'a>> {
        let mut best: Option<Nearest<'a>> = None;
        let is_worse = |distance, best: Option<Nearest>| best.is_some_and(|best| distance >= best.distance_squared);
        let mut stack = vec![(0_u32, 0.0)];
        while let Some((index, distance)) = stack.pop() {
            let Some(node) = self.nodes.get(index as usize).filter(|_| !is_worse(distance, best)) else { continue };
            if node.length == 0 {
                let mut children =
                    [index + 1, node.next].map(|child| (child, self.nodes[child as usize].distance(point)));
                if children[0].1 < children[1].1 {
                    children.swap(0, 1);
                }
                // The nearer one is taken first.
                stack.extend(children);
            }
            for &index in &self.order[node.next as usize..][..node.length as usize] {
                let triangle = &self.triangles[index as usize];
                let (weights, distance_squared) = nearest_on(triangle.positions(), point);
                if !is_worse(distance_squared, best) {
                    best = Some(Nearest { triangle, weights, distance_squared });
                }
            }
        }
        best
    }
}

fn split(triangles: &[Triangle], middles: &[Vec3], order: &mut [u32], start: u32, nodes: &mut Vec<Node>) {
    let corners = |&index: &u32| triangles[index as usize].corners.map(|corner| corner.position);
    let (low, high) = span(order.iter().flat_map(corners));
    let node = nodes.len();
    nodes.push(Node { low, high, next: start, length: order.len() as u32 });
    if order.len() <= LEAF_LENGTH {
        return;
    }
    let (low, high) = span(order.iter().map(|&index| middles[index as usize]));
    let axis = (high - low).max_position();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| middles[a as usize][axis].total_cmp(&middles[b as usize][axis]));
    let (first, second) = order.split_at_mut(half);
    split(triangles, middles, first, start, nodes);
    (nodes[node].next, nodes[node].length) = (nodes.len() as u32, 0);
    split(triangles, middles, second, start + half as u32, nodes);
}

/// The box around points.
fn span(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)))
}

impl Node {
    /// Squared distance of a point from the box.
    fn distance(&self, point: DVec3) -> f64 {
        let (low, high) = (self.low.as_dvec3(), self.high.as_dvec3());
        (low - point).max(point - high).max(DVec3::ZERO).length_squared()
    }
}

/// Weights of a triangle's nearest point, and its squared distance.
fn nearest_on(triangle: [DVec3; 3], point: DVec3) -> ([f64; 3], f64) {
    let [a, b, c] = triangle.map(|corner| corner - point);
    let normal = (b - a).cross(c - a);
    let areas = [b.cross(c).dot(normal), c.cross(a).dot(normal), a.cross(b).dot(normal)];
    let sum: f64 = areas.iter().sum();
    let distance = |[wa, wb, wc]: [f64; 3]| (wa * a + wb * b + wc * c).length_squared();
    if sum > 0.0 && areas.iter().all(|&area| area >= 0.0) {
        let weights = areas.map(|area| area / sum);
        return (weights, distance(weights));
    }
    let along = |from: DVec3, to: DVec3| {
        let edge = to - from;
        let length_squared = edge.length_squared();
        if length_squared > 0.0 { (-from.dot(edge) / length_squared).clamp(0.0, 1.0) } else { 0.0 }
    };
    let [ab, bc, ca] = [along(a, b), along(b, c), along(c, a)];
    [[1.0 - ab, ab, 0.0], [0.0, 1.0 - bc, bc], [ca, 0.0, 1.0 - ca]]
        .map(|weights| (weights, distance(weights)))
        .into_iter()
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
        .unwrap_or_default()
}
