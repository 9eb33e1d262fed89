//! Spokes as weighted sums of the cage's points, in f64 (Loop et al. 2009, section 4.3).
//!
//! Both patches at an edge read what they share from the same spoke, so its weights are the same there, whatever they are rounded to.

use std::collections::HashMap;

use super::spokes::SectorSpokes;
use crate::stencil::StencilTable;

/// A point or a vector: cage points in ascending order, each once, and their weights.
pub(crate) type Form = Vec<(u32, f64)>;

/// The weighted sum of forms.
pub(crate) fn sum_forms(terms: &[(f64, &[(u32, f64)])]) -> Form {
    let mut all: Form =
        terms.iter().flat_map(|&(w, form)| form.iter().map(move |&(point, x)| (point, w * x))).collect();
    all.sort_by_key(|&(point, _)| point);
    all.chunk_by(|a, b| a.0 == b.0).map(|same| (same[0].0, same.iter().map(|term| term.1).sum())).collect()
}

/// Carries points of finer levels back to the cage, by the stencil rows that make them.
pub(crate) struct Composer<'a> {
    stencils: &'a StencilTable,
    cage_point_count: u32,
    known: HashMap<u32, Form>,
}

impl<'a> Composer<'a> {
    pub fn new(stencils: &'a StencilTable, cage_point_count: u32) -> Self {
        Self { stencils, cage_point_count, known: HashMap::new() }
    }

    /// The weighted sum of points of all levels.
    pub fn sum(&mut self, terms: impl Iterator<Item = (u32, f64)>) -> Form {
        let forms: Vec<(f64, Form)> = terms.map(|(point, weight)| (weight, self.point(point))).collect();
        let terms: Vec<(f64, &[(u32, f64)])> = forms.iter().map(|(weight, form)| (*weight, form.as_slice())).collect();
        sum_forms(&terms)
    }

    fn point(&mut self, point: u32) -> Form {
        if point < self.cage_point_count {
            return vec![(point, 1.0)];
        }
        if let Some(form) = self.known.get(&point) {
            return form.clone();
        }
        let stencils = self.stencils;
        let row = &stencils.rows[(point - self.cage_point_count) as usize];
        let indices = &stencils.indices[row.first_index as usize..][..row.count as usize];
        let mut weights: Vec<f64> = (row.first_weight..row.first_weight + row.count)
            .map(|weight| f64::from(stencils.weights[weight as usize]))
            .collect();
        // Kernels take the others relative to the first.
        weights[0] = 1.0 - weights[1..].iter().sum::<f64>();
        let form = self.sum(indices.iter().copied().zip(weights));
        self.known.insert(point, form.clone());
        form
    }
}

/// What a limit point gives to the patches around it.
pub(crate) struct SpokeForms {
    /// The vertex' own point: what sums are taken relative to.
    pub origin: u32,
    /// Of the limit position.
    pub position: Form,
    /// Of each spoke's edge point; none where that is not linear in the points.
    pub edges: Option<Vec<Form>>,
    /// Of each spoke's vector r, without the weight of the origin.
    pub besides: Vec<Form>,
}

impl SpokeForms {
    /// Of the spokes of a sector of a vertex, whose point is `origin`; its level's points begin at `first_point`. `mask` is the f64
    /// limit mask in points of all levels.
    pub fn new(
        composer: &mut Composer<'_>,
        spokes: &SectorSpokes,
        origin: u32,
        first_point: u32,
        mask: &[(u32, [f64; 3])],
    ) -> Self {
        let [position, a, b] =
            [0, 1, 2].map(|c| composer.sum(mask.iter().map(|(point, weights)| (*point, weights[c]))));
        let is_linear = spokes.weights.iter().all(|spoke| !spoke.is_projected);
        let mut edge = |spoke: &super::spokes::SpokeWeights| {
            let end = composer.sum([(first_point + spoke.end, spoke.direct)].into_iter());
            let [along, across] = spoke.along;
            sum_forms(&[(1.0 - spoke.direct, &position), (along, &a), (across, &b), (1.0, &end)])
        };
        let edges = is_linear.then(|| spokes.weights.iter().map(&mut edge).collect());
        let beside = |spoke: &super::spokes::SpokeWeights| {
            composer.sum(spoke.beside.iter().map(|&(vertex, weight)| (first_point + vertex, weight)))
        };
        Self { origin, edges, besides: spokes.weights.iter().map(beside).collect(), position }
    }
}
