//! Whether a triangle may be seen, in double.

use glam::{DVec3, DVec4};
use planish_render::{CapturedVertex, FrameCamera};

/// A camera's rasterizer.
pub struct Rasterizer<'a> {
    pub camera: &'a FrameCamera,
    pub sub_pixel_bits: u32,
}

impl Rasterizer<'_> {
    fn clip(&self, vertex: &CapturedVertex) -> DVec4 {
        let point = DVec3::from(vertex.position.map(f64::from));
        self.camera.view_projection().as_dmat4() * point.extend(1.0)
    }

    /// Whether any of a triangle may be seen, but for what hides it.
    pub fn shows(&self, triangle: &[CapturedVertex], cull_back: bool) -> bool {
        let clip: [DVec4; 3] = std::array::from_fn(|i| self.clip(&triangle[i]));
        let is_beyond = |distance: fn(&DVec4) -> f64| clip.iter().all(|corner| distance(corner) < 0.0);
        let planes: [fn(&DVec4) -> f64; 5] =
            [|c| c.w + c.x, |c| c.w - c.x, |c| c.w + c.y, |c| c.w - c.y, |c| c.w - c.z];
        !(planes.into_iter().any(is_beyond) || cull_back && self.is_turned(&clip))
    }

    /// Whether it shows its back, or nothing, after its corners were moved to the rasterizer's grid.
    fn is_turned(&self, clip: &[DVec4; 3]) -> bool {
        if clip.iter().any(|corner| corner.w < corner.z) {
            // Clipped: by the sides of its plane.
            let [a, b, c] = clip.map(|corner| DVec3::new(corner.x, corner.y, corner.w));
            return a.dot(b.cross(c)) <= 0.0;
        }
        let [width, height] = self.camera.size.map(f64::from);
        let steps = f64::from(1_u32 << self.sub_pixel_bits);
        let [a, b, c] = clip.map(|corner| {
            let grid = |place: f64, size: f64| (0.5 * place * size * steps).round();
            [grid(corner.x / corner.w, width), grid(corner.y / corner.w, height)]
        });
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0
    }
}
