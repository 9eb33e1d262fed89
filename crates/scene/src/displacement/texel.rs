//! Raw values to displacements.
use super::{DisplacementKind, DisplacementRequest};

/// Longest displacement along an axis: as the largest coordinate of a cage.
const MAX_DISPLACEMENT: f32 = planish_subdiv::mesh::MAX_COORDINATE;

/// Folds scale and midpoint into texels, in double: a shader has only to filter.
pub struct TexelFold {
    pub kind: DisplacementKind,
    scale: f64,
    midpoint: f64,
    /// Texels that were not finite, or too far away, and do not displace.
    pub replaced: u64,
}

impl TexelFold {
    pub fn new(request: &DisplacementRequest) -> Self {
        Self { kind: request.kind, scale: request.scale, midpoint: request.midpoint, replaced: 0 }
    }

    /// Appends the displacement of a texel of raw values: one or three, as the kind has it.
    pub fn push(&mut self, raw: &[f64], to: &mut Vec<f32>) {
        // Adding 0 makes -0 a 0: products and sums of texels then have no sign that depends on their order.
        let displacement = |value: &f64| (self.scale * (value - self.midpoint)) as f32 + 0.0;
        let is_good = raw.iter().map(displacement).all(|value| value.abs() <= MAX_DISPLACEMENT);
        self.replaced += u64::from(!is_good);
        to.extend(raw.iter().map(|value| if is_good { displacement(value) } else { 0.0 }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folded(request: &DisplacementRequest, raw: &[f64]) -> (Vec<f32>, u64) {
        let mut fold = TexelFold::new(request);
        let mut values = Vec::new();
        raw.chunks(request.kind.channel_count()).for_each(|texel| fold.push(texel, &mut values));
        (values, fold.replaced)
    }

    #[test]
    fn displacement_is_scale_times_value_less_midpoint_rounded_once() {
        let request = DisplacementRequest { scale: 0.3, midpoint: 0.5, ..DisplacementRequest::new("a.exr") };
        let third = 1.0 / 3.0;
        let expected = vec![(0.3 * (third - 0.5)) as f32, 0.0, (0.3 * 0.5) as f32];
        assert_eq!(folded(&request, &[third, 0.5, 1.0]), (expected, 0));
    }

    #[test]
    fn texels_that_are_not_finite_do_not_displace_and_are_counted() {
        let request = DisplacementRequest::new("a.exr");
        let raw = [f64::NAN, 1.0, f64::INFINITY, f64::NEG_INFINITY, 1e37, -1e36];
        assert_eq!(folded(&request, &raw), (vec![0.0, 1.0, 0.0, 0.0, 0.0, -1e36], 4));
    }

    #[test]
    fn a_vector_with_one_bad_component_does_not_displace_at_all() {
        let request = DisplacementRequest { kind: DisplacementKind::Vector, ..DisplacementRequest::new("a.exr") };
        assert_eq!(folded(&request, &[1.0, f64::NAN, 2.0, 3.0, 4.0, 5.0]), (vec![0.0, 0.0, 0.0, 3.0, 4.0, 5.0], 1));
    }

    #[test]
    fn zeros_have_no_sign() {
        let request = DisplacementRequest { scale: -1.0, ..DisplacementRequest::new("a.exr") };
        assert_eq!(folded(&request, &[0.0]).0[0].to_bits(), 0);
        let request = DisplacementRequest { scale: 1e-30, ..DisplacementRequest::new("a.exr") };
        assert_eq!(folded(&request, &[-1e-30]).0[0].to_bits(), 0);
    }
}
