//! Light for scenes that have none: that of `glsl/shared/shading.glsl`, as lights and an environment that materials can be seen in.

use glam::{Affine3A, Mat3, Quat, Vec3};
use half::f16;

use super::desc::{LightDesc, LightKind};

/// Unit directions to the key, fill and rim light, and pi times what a white surface that faces them has.
const LIGHTS: [([f32; 3], [f32; 3]); 3] = [
    ([0.554, 0.755, 0.352], [1.12, 1.03, 0.90]),
    ([-0.820, 0.256, 0.512], [0.12, 0.16, 0.24]),
    ([-0.251, 0.351, -0.902], [0.34, 0.38, 0.46]),
];
/// Size of the environment.
const SIZE: [u32; 2] = [64, 32];

/// The lights; they cast no shadows.
pub fn studio_lights() -> Vec<LightDesc> {
    let light = |(direction, color): ([f32; 3], [f32; 3])| LightDesc {
        kind: LightKind::Distant { angle: 0.0 },
        to_world: Affine3A {
            matrix3: Mat3::from_quat(Quat::from_rotation_arc(Vec3::Z, Vec3::from(direction).normalize())).into(),
            translation: Vec3::ZERO.into(),
        },
        intensity: color.map(|value| std::f32::consts::PI * value),
        casts_shadows: false,
    };
    LIGHTS.into_iter().map(light).collect()
}

/// The image of a sky over a warm floor.
pub fn studio_environment() -> ([u32; 2], Vec<[f16; 4]>) {
    let (floor, sky) = (Vec3::new(0.045, 0.035, 0.03), Vec3::new(0.18, 0.21, 0.27));
    let texel = |i: u32| {
        let height = (std::f32::consts::PI * ((i / SIZE[0]) as f32 + 0.5) / SIZE[1] as f32).cos();
        let color = floor.lerp(sky, (0.5 + 1.5 * height).clamp(0.0, 1.0));
        [color.x, color.y, color.z, 1.0].map(f16::from_f32)
    };
    (SIZE, (0..SIZE[0] * SIZE[1]).map(texel).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_shine_from_where_they_are() {
        for (light, (direction, _)) in studio_lights().iter().zip(LIGHTS) {
            assert!((light.axis() + Vec3::from(direction)).length() < 2e-3);
        }
    }
}
