//! A frame as the CPU twins make it.

use planish_render::density::density;
use planish_render::emit::{EmitInput, Emitted, emit};
use planish_render::spokes::spokes;
use planish_render::table::{EmitTableInput, emit_table};
use planish_render::visibility::point_outside_planes;
use planish_render::{FrameCamera, FrameOptions, PatchKind, Spacing, limit, subdivide};
use planish_shaders::{FrameInput, LimitPoint, Object, SlotDensity};
use planish_subdiv::selection::{Cut, Selection, SlotDensities, density_rings, select};
use planish_subdiv::tables::{MeshRanges, Tables};

use crate::lab::Lab;
use crate::world::World;

/// `OBJECT_IN_HULL` of the shaders.
const IN_HULL: u32 = 1;

/// A frame.
pub struct Twin {
    /// Of each object.
    pub objects: Vec<TwinObject>,
    pub points: Vec<[f32; 3]>,
    pub limits: Vec<LimitPoint>,
    /// Entries of each kind, by object, place and flags.
    pub entries: Emitted,
    /// The largest density of a vertex.
    pub density: f32,
}

/// An object's part of a frame.
#[derive(Default)]
pub struct TwinObject {
    /// Densities, and the planes that vertices lie outside of: none of an object that is left out, unless the static selection
    /// asks for the largest of all.
    pub densities: Option<(SlotDensities, Vec<u32>)>,
    /// None of an object that is left out.
    pub cut: Option<Cut>,
}

impl Twin {
    /// Where quotients and roots are not the CPU's, its densities are the kernels', which are checked to be near: what follows from them
    /// does so by sums and products.
    pub fn new(lab: &Lab, world: &World, spacing: Spacing, camera: &FrameCamera, options: &FrameOptions) -> Self {
        let surface = &world.surface;
        let (tables, cage) = (surface.tables(), world.cage());
        let input = surface.frame_input(camera, options).expect("a frame");
        let seen: Vec<bool> = surface.objects().iter().map(|object| !is_left_out(object, &input)).collect();
        let is_static = options.selection == planish_render::Selection::Static;
        let made = (!lab.is_exact()).then(|| surface.download_densities(&lab.device).expect("densities"));
        let mut objects = Vec::new();
        for (index, object) in surface.objects().iter().enumerate() {
            let mesh = &surface.meshes()[world.objects[index].mesh];
            let of_object = || {
                let (densities, outside) = density(tables, mesh, surface.density_scales(), object, &input, &cage);
                let mut slots = density_rings(tables, mesh, &densities, &outside);
                if let Some(made) = &made {
                    take_densities(&mut slots, &made[object.first_slot as usize..]);
                }
                (slots, outside)
            };
            objects.push(TwinObject { densities: (seen[index] || is_static).then(of_object), cut: None });
        }
        let of_vertices = |(slots, outside): &(SlotDensities, Vec<u32>)| slots.density[..outside.len()].to_vec();
        let all = objects.iter().filter_map(|object| object.densities.as_ref()).flat_map(of_vertices);
        let largest = all.fold(0.0_f32, f32::max);
        let selection = if is_static { Selection::Static { frame_density: largest } } else { Selection::Dynamic };
        let points = subdivide::subdivide(tables, &cage);
        let (limits, tangents) = limit::limit_with_tangents(tables, &points);
        let spokes = spokes(tables, &points, &limits, &tangents);
        let mut twin = Self { objects, points, limits, entries: Emitted::default(), density: largest };
        for (index, object) in surface.objects().iter().enumerate().filter(|(index, _)| seen[*index]) {
            let mesh = &surface.meshes()[world.objects[index].mesh];
            let Some((slots, _)) = &twin.objects[index].densities else { continue };
            if surface.desc().method.is_grid() {
                let (object, points, view) = ((object, index as u32), &twin.points, &input.view);
                let input = EmitTableInput { tables, mesh, object, densities: &slots.density, points, view };
                twin.entries[PatchKind::Table as usize].extend(emit_table(&input));
                continue;
            }
            let cut = cut(tables, mesh, object, slots, selection);
            let emitted = emit(&EmitInput {
                tables,
                mesh,
                object: (object, index as u32),
                cut: &cut,
                densities: &slots.density,
                points: &twin.points,
                limits: &twin.limits,
                spokes: &spokes,
                view: &input.view,
                spacing,
            });
            twin.entries.iter_mut().zip(emitted).for_each(|(all, own)| all.extend(own));
            twin.objects[index].cut = Some(cut);
        }
        twin
    }

    /// What was selected of the objects that are not left out.
    pub fn cuts(&self) -> impl Iterator<Item = &Cut> {
        self.objects.iter().filter_map(|object| object.cut.as_ref())
    }
}

/// Replaces densities by those that kernels made, a few last places off.
fn take_densities(slots: &mut SlotDensities, made: &[SlotDensity]) {
    let densities = slots.density.iter_mut().zip(made.iter().map(|made| made.density));
    let rings = slots.ring.iter_mut().zip(made.iter().map(|made| made.ring));
    for (expected, made) in densities.chain(rings) {
        let is_near = (made - *expected).abs() <= 16.0 * f32::EPSILON * expected.abs();
        assert!(made == *expected || is_near, "density {made}, of its twin {expected}");
        *expected = made;
    }
}

fn cut(tables: &Tables, mesh: &MeshRanges, object: &Object, slots: &SlotDensities, selection: Selection) -> Cut {
    let mut known = slots.clone();
    if object.flags & IN_HULL == 0 {
        // The surface may be anywhere.
        known.ring_outside.fill(0);
    }
    select(tables, mesh, &known, selection)
}

impl TwinObject {
    /// As the kernels leave them, if they do; what lies outside is not told of faces' middles.
    pub fn slot_densities(&self) -> Option<Vec<SlotDensity>> {
        let (slots, outside) = self.densities.as_ref()?;
        let slot = |i: usize| SlotDensity {
            density: slots.density[i],
            ring: slots.ring[i],
            outside: outside.get(i).copied().unwrap_or_default(),
            ring_outside: slots.ring_outside[i],
        };
        Some((0..slots.density.len()).map(slot).collect())
    }
}

/// Twin of `glsl/objects.comp`: whether the box around an object lies outside of the view.
fn is_left_out(object: &Object, input: &FrameInput) -> bool {
    if input.view.cull == 0 || object.flags & IN_HULL == 0 {
        return false;
    }
    let corner = |corner: usize| {
        let p: [f32; 3] = std::array::from_fn(|c| if corner >> c & 1 != 0 { object.high[c] } else { object.low[c] });
        let m = &object.to_world;
        std::array::from_fn(|c| ((m[0][c] * p[0] + m[1][c] * p[1]) + m[2][c] * p[2]) + m[3][c])
    };
    (0..8).fold(31, |all, i| all & point_outside_planes(corner(i), &input.view, object.displacement)) != 0
}
