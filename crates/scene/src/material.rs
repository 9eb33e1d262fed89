//! What surfaces are made of: metallic-roughness materials and their textures.
use std::path::PathBuf;

/// A metallic-roughness material (glTF 2.0, appendix B; UsdPreviewSurface). Factors are linear; a texture multiplies its factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the file; Cryptomatte's too.
    pub name: String,
    /// Albedo of a dielectric, colour at normal incidence of a metal.
    pub base_color: [f32; 3],
    /// Multiplies `base_color`.
    pub base_color_texture: Option<TextureRef>,
    /// Opacity; `alpha` says what becomes of it.
    pub opacity: f32,
    /// Multiplies `opacity` by one channel.
    pub opacity_texture: Option<TextureRef>,
    /// What becomes of the opacity.
    pub alpha: AlphaMode,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// Multiplies `metallic` by one channel.
    pub metallic_texture: Option<TextureRef>,
    /// Perceptual roughness; the microfacets' alpha is its square.
    pub roughness: f32,
    /// Multiplies `roughness` by one channel.
    pub roughness_texture: Option<TextureRef>,
    /// Tangent-space normals; scale and bias of the reference make them vectors of -1 to 1.
    pub normal_texture: Option<TextureRef>,
    /// Ambient occlusion by one channel: it darkens what comes from the environment.
    pub occlusion_texture: Option<TextureRef>,
    /// How much of the occlusion is applied: 1 + strength * (value - 1).
    pub occlusion_strength: f32,
    /// Light of its own, any size: emissive strength is multiplied in.
    pub emissive: [f32; 3],
    /// Multiplies `emissive`.
    pub emissive_texture: Option<TextureRef>,
    /// Index of refraction of a dielectric: 1.5 reflects 4 %.
    pub ior: f32,
    /// Reflectance at normal incidence instead of what metallic, base colour and index make of it (the specular workflow of
    /// UsdPreviewSurface).
    pub specular: Option<[f32; 3]>,
    /// Share of a second, clear layer.
    pub clearcoat: f32,
    /// Its perceptual roughness.
    pub clearcoat_roughness: f32,
    /// Whether backs are there.
    pub double_sided: bool,
}

impl Default for Material {
    /// UsdPreviewSurface's and, but for the metallic factor, glTF's: a rough dielectric of 18 % grey.
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            base_color: [0.18; 3],
            base_color_texture: None,
            opacity: 1.0,
            opacity_texture: None,
            alpha: AlphaMode::Opaque,
            metallic: 0.0,
            metallic_texture: None,
            roughness: 0.5,
            roughness_texture: None,
            normal_texture: None,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            ior: 1.5,
            specular: None,
            clearcoat: 0.0,
            clearcoat_roughness: 0.01,
            double_sided: true,
        }
    }
}

impl Material {
    /// All its textures.
    pub fn textures(&self) -> impl Iterator<Item = &TextureRef> {
        [
            &self.base_color_texture,
            &self.opacity_texture,
            &self.metallic_texture,
            &self.roughness_texture,
            &self.normal_texture,
            &self.occlusion_texture,
            &self.emissive_texture,
        ]
        .into_iter()
        .flatten()
    }
}

/// What becomes of opacity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Ignored.
    #[default]
    Opaque,
    /// Below the threshold there is nothing, above it is opaque.
    Mask(f32),
    /// The share of samples that hit the surface.
    Blend,
}

/// A texture as a material uses it.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureRef {
    /// Into [`crate::Scene::textures`].
    pub texture: usize,
    /// Which channel a scalar is: 0 red to 3 alpha. Colours and normals use the first three.
    pub channel: u32,
    /// Texels are sRGB: they are decoded before they are filtered.
    pub is_srgb: bool,
    /// Texture coordinates to those of the image: rows of a 2 x 3 matrix that acts on (s, t, 1). The image's (0, 0) is its upper
    /// left corner, t runs down: readers of formats with t upwards turn it over here.
    pub transform: [[f32; 3]; 2],
    /// A filtered value v becomes v * scale + bias, channel by channel.
    pub scale: [f32; 4],
    /// See `scale`.
    pub bias: [f32; 4],
}

impl TextureRef {
    /// A texture as it is.
    pub fn plain(texture: usize) -> Self {
        Self {
            texture,
            channel: 0,
            is_srgb: false,
            transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            scale: [1.0; 4],
            bias: [0.0; 4],
        }
    }
}

/// An image and what lies beyond its edges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Into [`crate::Scene::images`].
    pub image: usize,
    /// Along s and t.
    pub wrap: [Wrap; 2],
    /// Nearest texels instead of filtered ones.
    pub is_nearest: bool,
}

/// What lies beyond the edges of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
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

/// An image file that textures are made of; it is decoded when it is needed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageSource {
    /// What messages call it.
    pub name: String,
    /// Where it is.
    pub content: ImageContent,
}

/// Where an image's bytes are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ImageContent {
    /// In a file of its own: PNG, JPEG, EXR, HDR or TIFF.
    File(PathBuf),
    /// In the scene file.
    Bytes(Vec<u8>),
}
