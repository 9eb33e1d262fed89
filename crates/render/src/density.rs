//! The density stage: how finely to tessellate at each vertex of each object's cage. Shader: `glsl/density.comp`; rings of
//! vertices follow in `glsl/density_rings.comp` (twin: [`planish_subdiv::selection::density_rings`]).

use planish_shaders::{FrameInput, Object};
use planish_subdiv::ControlMesh;
use planish_subdiv::tables::{MeshRanges, Tables};

use crate::camera::FrameCamera;
use crate::error::Error;
use crate::objects::{CageFacts, ObjectDesc, columns, to_world};
use crate::options::{Density, FrameOptions, Selection};
use crate::visibility::{dot, point_outside_planes, sub};

/// Densities are at most this; `MAX_DENSITY` of the shader.
pub const MAX_DENSITY: f32 = 16000.0;
/// Up to this density no patch is cut: both halves of an edge have 31 segments at most, whatever the spacing.
pub const MAX_UNCUT_DENSITY: f32 = 62.0;
/// `LEAST_DISTANCE` of the shader.
const LEAST_DISTANCE: f32 = 0.25;

/// The deepest level that a density refines to: the factor halves with each, and is 1 at the last (FAS section 4.1).
pub fn isolation_level(density: f32, max_level: u32) -> u32 {
    let level = (0..=max_level).find(|&k| density <= (k as f32).exp2());
    level.unwrap_or(max_level)
}

/// What the kernels need to know of a frame.
pub fn frame_input(
    camera: &FrameCamera,
    options: &FrameOptions,
    max_level: u32,
    object_count: u32,
    sub_pixel_bits: u32,
) -> Result<FrameInput, Error> {
    let (edge_scale, density) = match options.density {
        Density::Tess(factor) if (1.0..=MAX_DENSITY).contains(&factor) => (0.0, factor),
        Density::Tess(factor) => return Err(Error::TessFactor { factor }),
        Density::EdgePixels(pixels) if pixels > 0.0 && pixels.is_finite() => {
            (camera.projection.y_axis.y.abs() * camera.size[1] as f32 / pixels, 0.0)
        }
        Density::EdgePixels(pixels) => return Err(Error::EdgePixels { pixels }),
    };
    // The corner of the image lies at (1 / p_x, 1 / p_y) at depth 1.
    let [x, y] = [camera.projection.x_axis.x, camera.projection.y_axis.y].map(f64::from);
    let least_cosine = 1.0 / (1.0 + 1.0 / (x * x) + 1.0 / (y * y)).sqrt();
    Ok(FrameInput {
        view: crate::emit::emit_view(camera, options.culling, sub_pixel_bits),
        edge_scale,
        density,
        least_cosine: least_cosine as f32,
        selection: match options.selection {
            Selection::Dynamic => 0,
            Selection::Static => 1,
        },
        max_level,
        object_lod: u32::from(options.object_lod),
        object_count,
    })
}

/// A bound on the densities of a frame of these objects: the largest of an edge; a vertex has the mean of its edges'.
pub fn largest_density(
    meshes: &[&ControlMesh],
    objects: &[ObjectDesc],
    camera: &FrameCamera,
    options: &FrameOptions,
) -> Result<f32, Error> {
    // Nothing of it depends on levels, on the number of objects or on the grid of pixels.
    let frame = frame_input(camera, options, 0, 0, 0)?;
    let mut largest = 0.0_f32;
    for desc in objects {
        let mesh = meshes[desc.mesh];
        let scale = mesh.density.iter().copied().reduce(f32::max).unwrap_or(1.0);
        let density = if frame.density > 0.0 {
            frame.density
        } else {
            largest_edge_density(mesh, desc, &frame, options.object_lod)
        };
        largest = largest.max(bounded(density * scale));
    }
    Ok(largest)
}

fn largest_edge_density(mesh: &ControlMesh, desc: &ObjectDesc, frame: &FrameInput, object_lod: bool) -> f32 {
    let mut object = Object { to_world: columns(&desc.to_world), ..Object::default() };
    if object_lod {
        CageFacts::of_mesh(mesh).set(&mut object);
        let centre = std::array::from_fn(|c| 0.5 * (object.low[c] + object.high[c]));
        return bounded(sphere_density(frame, to_world(&object, centre), 0.5 * object.largest_edge));
    }
    let at = |vertex: u32| to_world(&object, mesh.positions[vertex as usize]);
    let (mut first, mut largest) = (0, 0.0_f32);
    for &sides in &mesh.face_sizes {
        let face = &mesh.face_vertices[first..first + sides as usize];
        first += sides as usize;
        for (i, &vertex) in face.iter().enumerate() {
            largest = largest.max(edge_density(frame, at(vertex), at(face[(i + 1) % face.len()])));
        }
    }
    largest
}

fn edge_density(frame: &FrameInput, a: [f32; 3], b: [f32; 3]) -> f32 {
    let centre = std::array::from_fn(|c| 0.5 * (a[c] + b[c]));
    let edge = sub(b, a);
    bounded(sphere_density(frame, centre, 0.5 * dot(edge, edge).sqrt()))
}

fn bounded(density: f32) -> f32 {
    if density > 0.0 { density.min(MAX_DENSITY) } else { 0.0 }
}

fn sphere_density(frame: &FrameInput, centre: [f32; 3], radius: f32) -> f32 {
    let d = sub(centre, frame.view.eye);
    let distance = dot(d, d).sqrt();
    let depth = dot(frame.view.clip_w, d);
    let beside = frame.least_cosine * distance;
    let nearest = LEAST_DISTANCE * radius;
    let away = depth.max(beside).max(nearest);
    let behind = depth / radius + 2.0;
    let fade = behind.clamp(0.0, 1.0);
    ((radius * frame.edge_scale) / away) * fade
}

/// CPU twin: density at each vertex of an object's cage, and the planes of the view that the vertex lies outside of, bit for bit
/// as the shader finds them. `cage` are the points of all cages.
pub fn density(
    tables: &Tables,
    mesh: &MeshRanges,
    scales: &[f32],
    object: &Object,
    frame: &FrameInput,
    cage: &[[f32; 3]],
) -> (Vec<f32>, Vec<u32>) {
    let at = |vertex: u32| to_world(object, cage[(object.first_point + vertex) as usize]);
    let of = |vertex: u32| {
        if frame.density > 0.0 {
            return frame.density;
        }
        if frame.object_lod != 0 {
            let centre = std::array::from_fn(|c| 0.5 * (object.low[c] + object.high[c]));
            return sphere_density(frame, to_world(object, centre), 0.5 * object.largest_edge);
        }
        let a = at(vertex);
        let slot = mesh.slots.start + vertex;
        let neighbours = tables.slots.neighbours.of(slot);
        let sum = neighbours.iter().fold(0.0, |sum: f32, &other| sum + edge_density(frame, a, at(other)));
        sum / neighbours.len().max(1) as f32
    };
    let vertices = 0..object.vertex_count;
    let densities =
        vertices.clone().map(|vertex| bounded(of(vertex) * scales[(object.first_point + vertex) as usize])).collect();
    let outside = |vertex: u32| match frame.view.cull {
        0 => 0,
        _ => point_outside_planes(at(vertex), &frame.view, object.displacement),
    };
    (densities, vertices.map(outside).collect())
}

#[cfg(test)]
mod tests {
    use glam::Mat4;

    use super::*;

    #[test]
    fn the_last_level_has_factor_one() {
        for (factor, level) in [(1.0, 0), (1.01, 1), (2.0, 1), (13.7, 4), (16.0, 4), (16.1, 5), (64.0, 6)] {
            assert_eq!(isolation_level(factor, 10), level);
            assert!(factor / (level as f32).exp2() <= 1.0);
        }
        assert_eq!(isolation_level(64.0, 3), 3);
    }

    fn frame() -> FrameInput {
        let projection = Mat4::from_cols_array_2d(&[
            [1.2, 0.0, 0.0, 0.0],
            [0.0, 2.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 0.1, 0.0],
        ]);
        let camera = FrameCamera { world_to_camera: Mat4::IDENTITY, projection, size: [300, 200] };
        let options = FrameOptions { density: Density::EdgePixels(4.0), ..FrameOptions::default() };
        frame_input(&camera, &options, 10, 1, 8).expect("a density")
    }

    #[test]
    fn a_sphere_ahead_has_its_projected_diameter() {
        // 2 r over the height of the view at its depth, 2 / 2 depth, of 200 pixels; edges of 4.
        let density = sphere_density(&frame(), [3.0, 1.0, -20.0], 2.0);
        assert!((density - 2.0 * 2.0 / 20.0 * 200.0 / 4.0).abs() < 1e-4, "{density}");
    }

    #[test]
    fn a_sphere_around_the_eye_has_a_bound_and_one_behind_it_none() {
        let frame = frame();
        let around = sphere_density(&frame, [0.0, 0.0, -0.01], 2.0);
        assert!((around - 4.0 * 400.0 / 4.0).abs() < 1e-3, "{around}");
        assert_eq!(sphere_density(&frame, [0.5, 0.0, 4.5], 2.0), 0.0);
        // It fades over the length of a radius.
        let behind = [2.0, 2.5, 3.0, 3.5, 4.0].map(|z| sphere_density(&frame, [0.0, 0.0, z], 2.0));
        assert!(behind.windows(2).all(|pair| pair[0] > pair[1]), "{behind:?}");
    }

    #[test]
    fn what_is_no_number_is_no_density() {
        assert_eq!([f32::NAN, -1.0, f32::NEG_INFINITY].map(bounded), [0.0; 3]);
        assert_eq!([f32::INFINITY, 1e30].map(bounded), [MAX_DENSITY; 2]);
    }
}
