//! What a scene's surfaces are made of and what lights them, as plain data.

use glam::{Affine3A, Mat3, Vec3};
use half::f16;

/// Texels of an image, rows from the top.
#[derive(Clone, Copy, Debug)]
pub enum Texels<'a> {
    /// Bytes of red, green, blue and alpha; sRGB ones are decoded before they are filtered.
    Bytes {
        /// The texels.
        texels: &'a [[u8; 4]],
        /// Whether red, green and blue are sRGB.
        is_srgb: bool,
    },
    /// Linear halves of red, green, blue and alpha.
    Halves(&'a [[f16; 4]]),
}

/// What lies beyond the edges of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureWrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored.
    Mirror,
    /// Its last texels.
    Clamp,
    /// Zeros.
    Black,
}

/// An image as textures use it.
#[derive(Clone, Copy, Debug)]
pub struct TextureDesc<'a> {
    /// Texels in a row, and rows; 1 to 32768 each.
    pub size: [u32; 2],
    /// `size[0] * size[1]` texels.
    pub texels: Texels<'a>,
    /// Beyond the edges, along s and t.
    pub wrap: [TextureWrap; 2],
    /// Texels as they are instead of filtered ones.
    pub is_nearest: bool,
}

/// A texture as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUseDesc {
    /// Into [`ShadingDesc::textures`].
    pub texture: usize,
    /// Which channel a scalar is: 0 red to 3 alpha.
    pub channel: u32,
    /// Texture coordinates to those of the image, whose (0, 0) is its upper left corner: rows that act on (s, t, 1).
    pub transform: [[f32; 3]; 2],
    /// A filtered value v becomes v * scale + bias.
    pub scale: [f32; 4],
    /// See `scale`.
    pub bias: [f32; 4],
}

impl TextureUseDesc {
    /// A texture as it is.
    pub fn plain(texture: usize) -> Self {
        let transform = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Self { texture, channel: 0, transform, scale: [1.0; 4], bias: [0.0; 4] }
    }
}

/// What becomes of a material's opacity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Ignored.
    #[default]
    Opaque,
    /// Below the threshold there is nothing.
    Mask(f32),
    /// The share of samples that hit the surface.
    Blend,
}

/// A metallic-roughness material. Factors are linear; textures multiply them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialDesc {
    /// Albedo of a dielectric, colour at normal incidence of a metal; times the colours of vertices.
    pub base_color: [f32; 3],
    /// See `alpha`.
    pub opacity: f32,
    /// What becomes of the opacity.
    pub alpha: Alpha,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// Perceptual: the microfacets' alpha is its square.
    pub roughness: f32,
    /// Radiance of its own.
    pub emissive: [f32; 3],
    /// Index of refraction of a dielectric.
    pub ior: f32,
    /// Reflectance at normal incidence instead of what the others make of it.
    pub specular: Option<[f32; 3]>,
    /// Share of a second, clear layer.
    pub clearcoat: f32,
    /// Its perceptual roughness.
    pub clearcoat_roughness: f32,
    /// How much of the occlusion's texture is applied.
    pub occlusion_strength: f32,
    /// Whether backs are there.
    pub double_sided: bool,
    /// What coverage tells it by.
    pub id: u32,
    /// Textures of base colour, opacity, metallic, roughness, normal, occlusion and emission.
    pub textures: [Option<TextureUseDesc>; 7],
}

impl Default for MaterialDesc {
    /// A rough dielectric of 18 % grey.
    fn default() -> Self {
        Self {
            base_color: [0.18; 3],
            opacity: 1.0,
            alpha: Alpha::Opaque,
            metallic: 0.0,
            roughness: 0.5,
            emissive: [0.0; 3],
            ior: 1.5,
            specular: None,
            clearcoat: 0.0,
            clearcoat_roughness: 0.01,
            occlusion_strength: 1.0,
            double_sided: true,
            id: 0,
            textures: [None; 7],
        }
    }
}

impl MaterialDesc {
    /// Whether some samples pass through it, or its backs are not there.
    pub fn has_holes(&self) -> bool {
        self.alpha != Alpha::Opaque || !self.double_sided
    }
}

/// Light from all around: an image in latitude and longitude, linear. Its middle column lies along -z of the environment's own space,
/// its left quarter along -x, its upper edge along +y.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentDesc<'a> {
    /// The image's size and radiances; none: the same from everywhere.
    pub image: Option<([u32; 2], &'a [[f16; 4]])>,
    /// Multiplies the image.
    pub color: [f32; 3],
    /// The environment's own space to the world: a rotation.
    pub to_world: Mat3,
    /// Whether it is seen behind the scene, which it covers.
    pub is_visible: bool,
}

/// What an object is made of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ObjectMaterials {
    /// Into [`ShadingDesc::materials`], one a slot of its mesh; slots beyond the end have none.
    pub materials: Vec<Option<usize>>,
    /// Which of the surface's meshes it is.
    pub mesh: usize,
    /// What coverage tells it by.
    pub id: u32,
}

/// A scene's materials and environment.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadingDesc<'a> {
    /// Images of the materials.
    pub textures: &'a [TextureDesc<'a>],
    /// Materials.
    pub materials: &'a [MaterialDesc],
    /// The slot of each Ptex face of each mesh ([`super::ptex_slots`]); empty: all are of the first slot. Meshes beyond the end have
    /// one slot.
    pub face_slots: &'a [Vec<u32>],
    /// One an object of the surface, in its order; objects beyond the end have no material.
    pub objects: &'a [ObjectMaterials],
    /// Light from all around.
    pub environment: Option<EnvironmentDesc<'a>>,
    /// Surfaces without a material are shaded as where there is no light at all: without this they are of the default material. For
    /// scenes that have neither lights nor an environment.
    pub has_studio: bool,
}

/// Kinds of lights: as `planish_scene::LightKind`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light along -z.
    Distant {
        /// Its diameter in the sky, degrees.
        angle: f32,
    },
    /// In all directions.
    Point {
        /// Of the sphere that it is.
        radius: f32,
        /// It fades to nothing at this distance; infinite for none.
        range: f32,
    },
    /// In a cone around -z.
    Spot {
        /// Of the sphere that it is.
        radius: f32,
        /// It fades to nothing at this distance; infinite for none.
        range: f32,
        /// Half angle within which it is full, radians.
        inner: f32,
        /// Half angle beyond which there is nothing, radians.
        outer: f32,
    },
}

/// A light at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightDesc {
    /// What it is.
    pub kind: LightKind,
    /// Light to world; it shines from the origin along -z.
    pub to_world: Affine3A,
    /// Point and spot: radiant intensity. Distant: the irradiance of a surface that faces it.
    pub intensity: [f32; 3],
    /// Whether it casts shadows.
    pub casts_shadows: bool,
}

impl LightDesc {
    /// The direction in which it shines.
    pub fn axis(&self) -> Vec3 {
        self.to_world.transform_vector3(-Vec3::Z).normalize_or(-Vec3::Z)
    }
}
