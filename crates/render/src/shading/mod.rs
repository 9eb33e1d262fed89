//! Shading by materials and lights, deferred: surfaces are drawn into a G-buffer ([`crate::Layers::Shading`]), and one compute kernel
//! shades it, sample by sample, into a sum that is read once.
//!
//! | module | idea |
//! |---|---|
//! | `desc` | materials, textures, lights and environments as plain data |
//! | `texture`, `filter` | images with their mipmaps in buffers; the twin of how they are filtered |
//! | `environment` | what rough surfaces reflect of an image of all around |
//! | `albedo_table` | how much GGX reflects in all |
//! | `lights`, `shadows` | where lights are in a sample, and their shadow maps |
//! | `pass` | the kernel, and the sum of its samples |
//!
//! A frame, for each of its samples:
//! 1. [`Shadows::set_lights`]; for each map [`Shadows::set_frame`] and a submission of [`Shadows::record`], again while
//!    [`Surface::grow`] says so. Lights without extent need this for the first sample alone.
//! 2. [`Surface::set_frame`] and a submission of [`crate::FrameStages::record`] and [`crate::DrawPasses::record`] into targets of
//!    [`crate::Layers::Shading`], again while [`Surface::grow`] says so.
//! 3. [`ShadePass::set_sample`] and a submission of [`ShadePass::record`].

mod albedo_table;
mod desc;
mod environment;
mod filter;
mod lights;
mod pass;
mod shadows;
mod studio;
mod texture;

use half::f16;
use planish_gpu::{Buffer, Device, Encoder};
use planish_shaders as shaders;
use planish_shaders::{DeviceAddress, MaterialTables, ShadedObject, Texture, TextureUse};
use planish_subdiv::ControlMesh;

pub use desc::{
    Alpha, EnvironmentDesc, LightDesc, LightKind, MaterialDesc, ObjectMaterials, ShadingDesc, Texels, TextureDesc,
    TextureUseDesc, TextureWrap,
};
pub use lights::SceneSphere;
pub use pass::{ID_SLOTS, IdCoverage, ShadePass, ShadedFrame};
pub use shadows::{MAX_LIGHTS, MAX_SHADOW_VIEWS, Shadows};
pub use studio::{studio_environment, studio_lights};
pub use texture::srgb_to_linear;

use crate::error::Error;
use crate::surface::Surface;
use crate::upload::{address, mapped, table};

/// `NO_TEXTURE` and `NO_MATERIAL` of `glsl/shared/materials.glsl`.
const NONE: u32 = u32::MAX;
/// [`shaders::Material::flags`], as `glsl/shared/materials.glsl` has them.
const MASK: u32 = 1;
const BLEND: u32 = 2;
const SPECULAR: u32 = 4;
const SINGLE_SIDED: u32 = 8;

/// The slots of a mesh's Ptex faces, by those of its faces: a face of n other than four sides has n.
pub fn ptex_slots(mesh: &ControlMesh, face_slots: &[u32]) -> Vec<u32> {
    let parts = mesh.face_sizes.iter().map(|&sides| if sides == 4 { 1 } else { sides as usize });
    face_slots.iter().zip(parts).flat_map(|(&slot, parts)| std::iter::repeat_n(slot, parts)).collect()
}

/// Materials, textures and the environment of a scene on the GPU.
pub struct Shading {
    tables: MaterialTables,
    /// Holds `tables`.
    input: Buffer,
    buffers: Vec<Buffer>,
    environment: shaders::Environment,
    has_holes: bool,
}

impl Shading {
    /// Uploads them for a surface of these objects. Frames of the surface must be recorded anew then.
    ///
    /// # Panics
    /// If a desc names a texture, material or mesh that is not there.
    pub fn new(device: &Device, surface: &mut Surface, desc: &ShadingDesc<'_>) -> Result<Self, Error> {
        let mut buffers = Vec::new();
        let mut textures = Vec::new();
        for texture in desc.textures {
            push_texture(device, texture, &mut textures, &mut buffers)?;
        }
        let environment = environment(device, desc.environment.as_ref(), &mut textures, &mut buffers)?;
        let mut materials: Vec<_> =
            desc.materials.iter().map(|material| packed(material, desc.textures.len())).collect();
        let without = if desc.has_studio { NONE } else { materials.len() as u32 };
        materials.push(packed(&MaterialDesc::default(), 0));
        let faces = FaceSlots::new(surface, desc, without);
        let mut put = |buffer: Buffer| {
            buffers.push(buffer);
            buffers.len() - 1
        };
        let places = [
            put(table(device, "materials", &materials)?),
            put(table(device, "textures", &textures)?),
            put(table(device, "materials of objects", &faces.objects)?),
            put(table(device, "slots of faces", &faces.face_slots)?),
            put(table(device, "materials of slots", &faces.slot_materials)?),
            put(table(device, "sRGB", &texture::srgb_table())?),
        ];
        let [materials, textures, objects, face_slots, slot_materials, srgb] = places.map(|place| &buffers[place]);
        let tables = MaterialTables {
            materials: address(materials),
            textures: address(textures),
            objects: address(objects),
            face_slots: address(face_slots),
            slot_materials: address(slot_materials),
            srgb: address(srgb),
            has_studio: u32::from(desc.has_studio),
            sample_index: 0,
        };
        let input = mapped::<MaterialTables>(device, "shading", 1)?;
        input.write(0, &[tables])?;
        let has_holes = desc.materials.iter().any(MaterialDesc::has_holes);
        surface.set_materials(if has_holes { input.address() } else { 0 })?;
        Ok(Self { tables, input, buffers, environment, has_holes })
    }

    /// Whether some samples pass through a material: [`crate::FrameNeeds::cutouts`].
    pub fn has_holes(&self) -> bool {
        self.has_holes
    }

    /// Makes materials that blend show other samples of what is behind: before a frame is submitted.
    pub fn set_sample(&self, sample: u32) -> Result<(), Error> {
        Ok(self.input.write(0, &[MaterialTables { sample_index: sample, ..self.tables }])?)
    }

    /// Keeps all buffers alive as long as a recording.
    pub fn keep(&self, encoder: &mut Encoder) {
        self.buffers.iter().chain([&self.input]).for_each(|buffer| encoder.keep(buffer));
    }

    pub(crate) fn address(&self) -> DeviceAddress<shaders::MaterialScene> {
        address(&self.input)
    }

    pub(crate) fn environment(&self) -> shaders::Environment {
        self.environment
    }
}

fn push_texture(
    device: &Device,
    desc: &TextureDesc<'_>,
    textures: &mut Vec<Texture>,
    buffers: &mut Vec<Buffer>,
) -> Result<(), Error> {
    let (texture, buffer) = texture::upload(device, desc)?;
    textures.push(texture);
    buffers.push(buffer);
    Ok(())
}

/// Appends the environment's textures.
fn environment(
    device: &Device,
    desc: Option<&EnvironmentDesc<'_>>,
    textures: &mut Vec<Texture>,
    buffers: &mut Vec<Buffer>,
) -> Result<shaders::Environment, Error> {
    let Some(desc) = desc else { return Ok(shaders::Environment::default()) };
    let prepared = environment::prepare(desc);
    let first_texture = textures.len() as u32;
    let mut push = |size: [u32; 2], texels: &[[f16; 4]]| {
        let wrap = [TextureWrap::Repeat, TextureWrap::Clamp];
        let desc = TextureDesc { size, texels: Texels::Halves(texels), wrap, is_nearest: false };
        push_texture(device, &desc, textures, buffers)
    };
    push(prepared.mirror.0, &prepared.mirror.1)?;
    for image in prepared.rough.iter().chain([&prepared.irradiance]) {
        push(image.size, &image.halves())?;
    }
    let texture_count = 1 + prepared.rough.len() as u32;
    Ok(shaders::Environment {
        color: desc.color,
        first_texture,
        // A rotation's inverse is its transpose, whose rows are its columns.
        to_own: desc.to_world.to_cols_array_2d(),
        texture_count,
        irradiance: first_texture + texture_count,
        is_there: 1,
        is_visible: u32::from(desc.is_visible),
        padding: 0,
    })
}

/// Which material each place of the objects has.
struct FaceSlots {
    objects: Vec<ShadedObject>,
    face_slots: Vec<u32>,
    slot_materials: Vec<u32>,
}

impl FaceSlots {
    fn new(surface: &Surface, desc: &ShadingDesc<'_>, without: u32) -> Self {
        let mut first_of_mesh = Vec::new();
        let mut face_slots = Vec::new();
        for slots in desc.face_slots {
            first_of_mesh.push(if slots.is_empty() { NONE } else { face_slots.len() as u32 });
            face_slots.extend_from_slice(slots);
        }
        let none = ObjectMaterials::default();
        let mut objects = Vec::new();
        let mut slot_materials = Vec::new();
        for (index, object) in surface.objects().iter().enumerate() {
            let own = desc.objects.get(index).unwrap_or(&none);
            let first_face_slot = first_of_mesh.get(own.mesh).copied().unwrap_or(NONE);
            let slots = desc.face_slots.get(own.mesh).and_then(|slots| slots.iter().max());
            let slot_count = slots.map_or(1, |&last| last + 1);
            let materials = (0..slot_count as usize).map(|slot| match own.materials.get(slot) {
                Some(&Some(material)) => {
                    assert!(material < desc.materials.len(), "material {material} of object {index}");
                    material as u32
                }
                _ => without,
            });
            objects.push(ShadedObject {
                first_face: object.first_face,
                first_slot: slot_materials.len() as u32,
                slot_count,
                first_face_slot,
                id: own.id,
            });
            slot_materials.extend(materials);
        }
        Self { objects, face_slots, slot_materials }
    }
}

/// A material as the shaders read it.
fn packed(desc: &MaterialDesc, texture_count: usize) -> shaders::Material {
    let (alpha, threshold) = match desc.alpha {
        Alpha::Opaque => (0, 0.0),
        Alpha::Mask(threshold) => (MASK, threshold),
        Alpha::Blend => (BLEND, 0.0),
    };
    let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    let one_use = |desc: &Option<TextureUseDesc>| match desc {
        None => TextureUse { texture: NONE, ..TextureUse::default() },
        Some(desc) => {
            assert!(desc.texture < texture_count, "texture {}", desc.texture);
            TextureUse {
                texture: desc.texture as u32,
                channel: desc.channel,
                to_s: desc.transform[0],
                to_t: desc.transform[1],
                scale: desc.scale,
                bias: desc.bias,
            }
        }
    };
    let uses: Vec<TextureUse> = desc.textures.iter().map(one_use).collect();
    shaders::Material {
        base_color: desc.base_color,
        opacity: desc.opacity,
        emissive: desc.emissive,
        threshold,
        specular: desc.specular.unwrap_or_default(),
        reflectance: ((desc.ior - 1.0) / (desc.ior + 1.0)).powi(2),
        metallic: desc.metallic,
        roughness: desc.roughness,
        clearcoat: desc.clearcoat,
        clearcoat_roughness: desc.clearcoat_roughness,
        occlusion_strength: desc.occlusion_strength,
        flags: alpha | flag(desc.specular.is_some(), SPECULAR) | flag(!desc.double_sided, SINGLE_SIDED),
        id: desc.id,
        uses: std::array::from_fn(|i| uses[i]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ptex_faces_of_an_n_gon_have_its_slot() {
        let mesh = ControlMesh { face_sizes: vec![4, 5, 3, 4], ..ControlMesh::default() };
        assert_eq!(ptex_slots(&mesh, &[1, 2, 3, 4]), [1, 2, 2, 2, 2, 2, 3, 3, 3, 4]);
        assert_eq!(ptex_slots(&mesh, &[]), []);
    }

    #[test]
    fn an_index_of_1_5_reflects_4_percent() {
        assert!((packed(&MaterialDesc::default(), 0).reflectance - 0.04).abs() < 1e-6);
    }
}
