//! Where a vertex goes in the limit, and the plane that touches the surface there: from the rules of a scheme alone.
//!
//! Splitting a mesh again and again, what lies around a vertex soon hangs together as before. From then on one matrix S takes its
//! points to the next level's. The limit position is S's left eigenvector of 1. Differences to the vertex have a matrix of their own,
//! of S's rows less the vertex', without the eigenvalue 1; the plane is spanned by the two left eigenvectors of the largest
//! eigenvalues of that one, found by iterating both at once (orthogonal iteration).

use std::cell::OnceCell;
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::PI;
use std::rc::Rc;

use crate::basis::poly::{CUT, Fan, Poly};
use crate::basis::step::Step;
use crate::basis::walk::{Walk, walk};
use crate::mesh::{Creasing, INFINITE_SHARPNESS};
use crate::scheme::Rules;

/// Steps after which what lies around a vertex does not change any more: sharpness below 10 is gone, and all are isolated.
const MAX_STEPS: usize = 20;
/// Rounds of the iterations: ratios of eigenvalues up to 0.95 are gone in double precision.
const ROUNDS: usize = 700;

/// Weights of the points around a vertex, in the order of their walk.
#[derive(Clone, Debug)]
pub(crate) struct LimitMask {
    pub position: Vec<f64>,
    /// Two tangents, whose cross product points outward.
    pub tangents: [Vec<f64>; 2],
}

/// Masks by what lies around a vertex.
#[derive(Default)]
pub(crate) struct LimitMasks {
    known: HashMap<Vec<u32>, LimitMask>,
    /// By the word of a piece, too. Pieces that differ in how sharp they are soon become the same.
    stages: HashMap<Vec<u32>, Rc<Stage>>,
}

/// What becomes of a piece in one step.
struct Stage {
    /// What lies around the vertex then, and its points in those of before.
    walked: Walk,
    rows: Vec<Vec<(u32, f64)>>,
    /// Weights of the position and of the tangents, if it stays so.
    stationary: OnceCell<[Vec<f64>; 3]>,
}

/// How many pieces infinitely sharp edges cut the fan of a vertex into, and the piece that a spoke's face is in: its first spoke, how
/// many faces it has, and whether it is the whole closed fan.
pub(crate) struct Sector {
    pub count: usize,
    pub first: u32,
    pub faces: usize,
    pub is_closed: bool,
}

impl Sector {
    /// The sector of a whole vertex that face `face` of its fan lies in.
    pub fn new(poly: &Poly, fan: &Fan, face: usize) -> Self {
        let faces = fan.spokes.len();
        let is_sharp =
            |edge: usize| poly.edge_sharpness[fan.edges[edge % fan.edges.len()] as usize] >= INFINITE_SHARPNESS;
        let sharp = (0..fan.edges.len()).filter(|&edge| is_sharp(edge)).count();
        if fan.is_closed && sharp < 2 {
            return Self { count: 1, first: fan.spokes[face], faces, is_closed: true };
        }
        let begin = (0..=face).rev().find(|&edge| is_sharp(edge));
        // In a closed fan the sector may begin before the first spoke.
        let begin = begin.unwrap_or_else(|| (face..faces).rev().find(|&edge| is_sharp(edge)).unwrap_or(0));
        let span = (1..=faces).find(|&span| is_sharp(begin + span)).unwrap_or(faces);
        Self {
            count: if fan.is_closed { sharp } else { sharp - 1 },
            first: fan.spokes[begin],
            faces: span,
            is_closed: false,
        }
    }
}

/// The piece around a vertex that its mask is over.
pub(crate) fn around(poly: &Poly, fan: &Fan, sector: &Sector, width: u32) -> Walk {
    let first = fan.spokes.iter().position(|&spoke| spoke == sector.first).unwrap_or(0);
    let spokes: Vec<u32> = (0..sector.faces).map(|i| fan.spokes[(first + i) % fan.spokes.len()]).collect();
    let mut faces: Vec<u32> = spokes.iter().map(|&spoke| poly.face[spoke as usize]).collect();
    faces.sort_unstable();
    let mut closed: Vec<u32> = if sector.is_closed || !fan.is_closed && sector.count == 1 {
        Vec::new()
    } else {
        [first, first + sector.faces].map(|edge| fan.edges[edge % fan.edges.len()]).to_vec()
    };
    if width > 1 {
        let beyond = poly.ring(&faces, width - 1);
        if closed.is_empty() {
            faces = beyond;
        } else {
            faces = reached(poly, &faces, &beyond);
            // Where those edges go on the piece ends too: it would not know how.
            let is_left = |&h: &u32| {
                let twin = poly.twin(h);
                twin < CUT
                    && poly.sharpness(h) >= INFINITE_SHARPNESS
                    && faces.binary_search(&poly.face[twin as usize]).is_err()
            };
            let left = faces.iter().flat_map(|&face| poly.half_edges(face)).filter(is_left);
            closed.extend(left.map(|h| poly.edge[h as usize]));
        }
    }
    walk(poly, sector.first, &faces, &closed)
}

/// Those of `all` that are reached from `from` without crossing an infinitely sharp edge.
fn reached(poly: &Poly, from: &[u32], all: &[u32]) -> Vec<u32> {
    let mut found = from.to_vec();
    let mut next = 0;
    while let Some(&face) = found.get(next) {
        next += 1;
        for h in poly.half_edges(face) {
            let twin = poly.twin(h);
            let is_open = twin < CUT && poly.sharpness(h) < INFINITE_SHARPNESS;
            if is_open
                && all.binary_search(&poly.face[twin as usize]).is_ok()
                && !found.contains(&poly.face[twin as usize])
            {
                found.push(poly.face[twin as usize]);
            }
        }
    }
    found.sort_unstable();
    found
}

impl LimitMasks {
    /// The mask over a piece around the vertex that its walk began with.
    pub fn of(&mut self, rules: &dyn Rules, walk: &Walk, creasing: Creasing) -> &LimitMask {
        if !self.known.contains_key(&walk.word) {
            let mask = self.make(rules, walk, creasing);
            self.known.insert(walk.word.clone(), mask);
        }
        &self.known[&walk.word]
    }

    fn make(&mut self, rules: &dyn Rules, walk: &Walk, creasing: Creasing) -> LimitMask {
        let vertex_count = walk.vertices.len();
        // The points of the piece as weights of those that it began with.
        let mut values: Matrix = (0..vertex_count).map(|i| unit(vertex_count, i)).collect();
        let first = walk.poly(creasing);
        let mut word = around_first(&first, first.width(rules)).word;
        let mut stage = self.stage(rules, walk, creasing);
        let mut own = walk.clone();
        for step in 0.. {
            let is_the_same = stage.walked.word == word && stage.rows.len() == values.len();
            if is_the_same || step == MAX_STEPS {
                let weights = stage.stationary.get_or_init(|| stationary_weights(&own.poly(creasing), &stage.rows));
                return mask_in_first(weights, &values);
            }
            values = stage.rows.iter().map(|row| weighed(row, &values)).collect();
            own = stage.walked.clone();
            word.clone_from(&own.word);
            stage = self.stage(rules, &own, creasing);
        }
        unreachable!("the loop returns")
    }

    /// A step of a piece as it is walked.
    fn stage(&mut self, rules: &dyn Rules, walk: &Walk, creasing: Creasing) -> Rc<Stage> {
        let stage = self.stages.entry(walk.word.clone()).or_insert_with(|| {
            let (walked, rows) = next_around(&walk.poly(creasing), rules);
            Rc::new(Stage { walked, rows, stationary: OnceCell::new() })
        });
        Rc::clone(stage)
    }
}

/// A matrix, row by row; rows weigh the points of a piece.
type Matrix = Vec<Vec<f64>>;

/// The piece around vertex 0 of a piece, of whose half-edges the first starts there.
fn around_first(poly: &Poly, width: u32) -> Walk {
    let fan = poly.fan(0, Some(0));
    let faces: Vec<u32> = fan.spokes.iter().map(|&spoke| poly.face[spoke as usize]).collect();
    let mut faces = faces;
    faces.sort_unstable();
    let faces = poly.ring(&faces, width - 1);
    walk(poly, 0, &faces, &[])
}

/// What lies around the vertex a level further, and its points in the points of this level.
fn next_around(poly: &Poly, rules: &dyn Rules) -> (Walk, Vec<Vec<(u32, f64)>>) {
    let step = Step::new(poly, rules);
    // The child at corner 0 of face 0 is the first one.
    let walked = around_first(&step.child, poly.width(rules));
    let rows = walked.vertices.iter().map(|&vertex| step.rows[vertex as usize].clone().unwrap_or_default());
    let rows = rows.collect();
    (walked, rows)
}

fn unit(size: usize, at: usize) -> Vec<f64> {
    let mut row = vec![0.0; size];
    row[at] = 1.0;
    row
}

fn weighed(row: &[(u32, f64)], values: &Matrix) -> Vec<f64> {
    let mut sum = vec![0.0; values[0].len()];
    for &(point, weight) in row {
        sum.iter_mut().zip(&values[point as usize]).for_each(|(sum, value)| *sum += weight * value);
    }
    sum
}

/// Position and tangents of a piece that stays as it is, over its points.
fn stationary_weights(poly: &Poly, rows: &[Vec<(u32, f64)>]) -> [Vec<f64>; 3] {
    let size = rows.len();
    let mut position = unit(size, 0);
    for _ in 0..ROUNDS {
        position = left_multiplied(&position, rows, size);
    }
    let total: f64 = position.iter().sum();
    position.iter_mut().for_each(|weight| *weight /= total);
    let [u, v] = tangents(poly, rows);
    [position, u, v]
}

/// The same over the points that the piece began with.
fn mask_in_first([position, u, v]: &[Vec<f64>; 3], values: &Matrix) -> LimitMask {
    let in_first = |weights: &[f64]| {
        let row: Vec<(u32, f64)> = (0..).zip(weights.iter().copied()).collect();
        weighed(&row, values)
    };
    LimitMask { position: in_first(position), tangents: [in_first(u), in_first(v)] }
}

fn left_multiplied(weights: &[f64], rows: &[Vec<(u32, f64)>], size: usize) -> Vec<f64> {
    let mut result = vec![0.0; size];
    for (weight, row) in weights.iter().zip(rows) {
        row.iter().for_each(|&(point, w)| result[point as usize] += weight * w);
    }
    result
}

/// Where the points around the vertex would lie if the surface were flat: what tells which way round tangents run.
fn flat(poly: &Poly) -> Vec<[f64; 2]> {
    let fan = poly.fan(0, Some(0));
    let whole = if fan.is_closed { 2.0 * PI } else { PI };
    let step = whole / fan.spokes.len() as f64;
    let mut flat = vec![[0.0; 2]; poly.vertex_sharpness.len()];
    let mut put =
        |vertex: u32, angle: f64, radius: f64| flat[vertex as usize] = [radius * angle.cos(), radius * angle.sin()];
    for (i, &end) in fan.ends.iter().enumerate() {
        put(end, step * i as f64, 1.0);
    }
    for (i, &spoke) in fan.spokes.iter().enumerate() {
        let vertices = poly.sides(poly.face[spoke as usize]);
        let mut h = poly.next(poly.next(spoke));
        for _ in 0..vertices.saturating_sub(3) {
            put(poly.origin(h), step * (i as f64 + 0.5), 1.4);
            h = poly.next(h);
        }
    }
    flat
}

/// Two tangents at vertex 0, over the points of the piece.
fn tangents(poly: &Poly, rows: &[Vec<(u32, f64)>]) -> [Vec<f64>; 2] {
    let size = rows.len();
    let fan = poly.fan(0, Some(0));
    // Differences to the vertex: rows less the vertex' row; its own weight is what makes the sum 0.
    let own: BTreeMap<u32, f64> = rows[0].iter().copied().collect();
    let reduced: Vec<Vec<(u32, f64)>> = rows
        .iter()
        .map(|row| {
            let mut less: BTreeMap<u32, f64> = own.iter().map(|(&point, &weight)| (point, -weight)).collect();
            row.iter().for_each(|&(point, weight)| *less.entry(point).or_default() += weight);
            less.into_iter().filter(|&(point, weight)| point != 0 && weight != 0.0).collect()
        })
        .collect();
    let is_single = !fan.is_closed && fan.spokes.len() == 1;
    if is_single || poly.vertex_sharpness[0] >= INFINITE_SHARPNESS {
        // One face, or a corner: between the edges that bound the sector; of a cone any two of them.
        let last = if fan.is_closed { fan.ends[fan.ends.len() / 3 + 1] } else { fan.ends[fan.ends.len() - 1] };
        let along = |end: u32| {
            let mut row = unit(size, end as usize);
            // A boundary has points of its own; of a curve through more than the next one the direction is known in the limit.
            for _ in 0..if fan.is_closed { 0 } else { ROUNDS } {
                row = left_multiplied(&row, &reduced, size);
                normalize(&mut row);
            }
            with_sum_0(row)
        };
        return [along(fan.ends[0]), along(last)];
    }
    let flat = flat(poly);
    let mut plane: [Vec<f64>; 2] = std::array::from_fn(|axis| flat.iter().map(|at| at[axis]).collect());
    for _ in 0..ROUNDS {
        plane = plane.map(|row| left_multiplied(&row, &reduced, size));
        orthonormalize(&mut plane);
    }
    let slope = |row: &[f64]| -> [f64; 2] {
        std::array::from_fn(|axis| row.iter().zip(&flat).map(|(weight, at)| weight * at[axis]).sum())
    };
    let [a, b] = [slope(&plane[0]), slope(&plane[1])];
    if a[0] * b[1] - a[1] * b[0] < 0.0 {
        plane[1].iter_mut().for_each(|weight| *weight = -*weight);
    }
    plane.map(with_sum_0)
}

/// Differences to the vertex as weights of points.
fn with_sum_0(mut row: Vec<f64>) -> Vec<f64> {
    row[0] = 0.0;
    row[0] = -row.iter().sum::<f64>();
    row
}

fn normalize(row: &mut [f64]) {
    let length = row.iter().map(|w| w * w).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    row.iter_mut().for_each(|weight| *weight /= length);
}

fn orthonormalize([a, b]: &mut [Vec<f64>; 2]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    normalize(a);
    let along = dot(a, b);
    b.iter_mut().zip(a.iter()).for_each(|(b, a)| *b -= along * a);
    normalize(b);
}
