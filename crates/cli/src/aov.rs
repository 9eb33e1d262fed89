//! Layers beside the colour: their names, and what they hold.

use std::str::FromStr;

use planish_film::Layer;
use planish_render::{Layers, NO_SURFACE};

/// Bits of the packed id below the level; see [`planish_render::Targets`].
const PATCH_BITS: u32 = 28;

/// A layer of an EXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    /// Distance from the camera along its line of sight; infinite where there is no surface.
    Depth,
    /// Unit normal of the limit surface, in world space.
    Normal,
    /// Position, in world space.
    Position,
    /// Parameters in the Ptex face.
    Uv,
    /// Ptex face.
    Face,
    /// Patch: its place in the table of patches, with the irregular faces after them.
    Patch,
    /// Level of the patch.
    Level,
    /// Tess factor of the patch.
    Tess,
    /// Colour of vertices.
    Color,
    /// Texture coordinates of the mesh's first channel.
    TexCoord,
    /// Instance, counted through all.
    Object,
    /// Where the point goes until the next frame, in pixels to the right and down.
    Motion,
    /// Cryptomatte of instances.
    CryptoObject,
    /// Cryptomatte of materials.
    CryptoMaterial,
}

impl Aov {
    /// Whether it is a Cryptomatte.
    pub fn is_matte(self) -> bool {
        matches!(self, Self::CryptoObject | Self::CryptoMaterial)
    }

    /// Every layer with its name.
    const NAMES: [(&'static str, Self); 14] = [
        ("z", Self::Depth),
        ("n", Self::Normal),
        ("p", Self::Position),
        ("uv", Self::Uv),
        ("face", Self::Face),
        ("patch", Self::Patch),
        ("level", Self::Level),
        ("tess", Self::Tess),
        ("color", Self::Color),
        ("st", Self::TexCoord),
        ("object", Self::Object),
        ("motion", Self::Motion),
        ("crypto_object", Self::CryptoObject),
        ("crypto_material", Self::CryptoMaterial),
    ];
}

/// Comma-separated names of layers, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AovList {
    aovs: Vec<Aov>,
}

impl AovList {
    /// The layers asked for.
    pub fn aovs(&self) -> &[Aov] {
        &self.aovs
    }
}

fn known_names() -> String {
    Aov::NAMES.map(|(known, _)| known).join(", ")
}

impl FromStr for AovList {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut list = Self::default();
        for name in text.split(',').map(|name| name.trim().to_lowercase()).filter(|name| !name.is_empty()) {
            let found = Aov::NAMES.iter().find(|(known, _)| *known == name);
            let &(_, aov) = found.ok_or_else(|| format!("layer {name} is unknown (known: {})", known_names()))?;
            if !list.aovs.contains(&aov) {
                list.aovs.push(aov);
            }
        }
        Ok(list)
    }
}

/// The images of layers as the device packs them ([`planish_render::Targets`]), one entry a pixel.
#[derive(Clone, Debug, Default)]
pub struct PackedLayers {
    /// Normal and depth.
    pub normal_depth: Vec<[f32; 4]>,
    /// Position and tess factor.
    pub position_factor: Vec<[f32; 4]>,
    /// Ptex face, patch and level, u and v as bits.
    pub ids: Vec<[u32; 4]>,
    /// Colours of vertices; empty unless they were drawn.
    pub colors: Vec<[f32; 4]>,
    /// Motion in pixels, and texture coordinates; likewise.
    pub motion_st: Vec<[f32; 4]>,
    /// The first Ptex face of each object.
    pub first_faces: Vec<u32>,
}

impl PackedLayers {
    /// The layer of an AOV; none of a Cryptomatte, which is of all samples. Where there is no surface floats are 0, but the depth is
    /// infinite, and ids are `u32::MAX`.
    pub fn layer(&self, aov: Aov) -> Option<Layer> {
        Some(match aov {
            Aov::CryptoObject | Aov::CryptoMaterial => return None,
            Aov::Depth => Layer::float("Z", &[], self.depths()),
            Aov::Normal => Layer::float("N", &["X", "Y", "Z"], vectors(&self.normal_depth)),
            Aov::Position => Layer::float("P", &["X", "Y", "Z"], vectors(&self.position_factor)),
            Aov::Uv => {
                let uv =
                    |id: &[u32; 4]| if id[0] == NO_SURFACE { [0.0; 2] } else { [id[2], id[3]].map(f32::from_bits) };
                Layer::float("uv", &["x", "y"], self.ids.iter().flat_map(uv).collect())
            }
            Aov::Face => self.ids_as("face", |id| id[0]),
            Aov::Patch => self.ids_as("patch", |id| id[1] & ((1 << PATCH_BITS) - 1)),
            Aov::Level => self.ids_as("level", |id| id[1] >> PATCH_BITS),
            Aov::Tess => Layer::float("tess", &[], self.position_factor.iter().map(|pixel| pixel[3]).collect()),
            Aov::Color => Layer::float("color", &["R", "G", "B"], vectors(&self.colors)),
            Aov::TexCoord => {
                Layer::float("st", &["x", "y"], self.motion_st.iter().flat_map(|&[_, _, s, t]| [s, t]).collect())
            }
            Aov::Motion => {
                Layer::float("motion", &["x", "y"], self.motion_st.iter().flat_map(|&[x, y, ..]| [x, y]).collect())
            }
            Aov::Object => self.ids_as("object", |id| self.object_of(id[0])),
        })
    }

    /// The object that has a Ptex face: the last that begins with it or before, of those that have faces at all.
    fn object_of(&self, ptex_face: u32) -> u32 {
        (self.first_faces.partition_point(|&first| first <= ptex_face).max(1) - 1) as u32
    }

    fn depths(&self) -> Vec<f32> {
        let depth = |(pixel, id): (&[f32; 4], &[u32; 4])| if id[0] == NO_SURFACE { f32::INFINITY } else { pixel[3] };
        self.normal_depth.iter().zip(&self.ids).map(depth).collect()
    }

    fn ids_as(&self, name: &str, value: impl Fn(&[u32; 4]) -> u32) -> Layer {
        let value = |id: &[u32; 4]| if id[0] == NO_SURFACE { u32::MAX } else { value(id) };
        Layer::uint(name, self.ids.iter().map(value).collect())
    }
}

/// What must be drawn for these layers.
pub fn drawn_layers(aovs: &[Aov]) -> Layers {
    match aovs {
        aovs if aovs.iter().all(|aov| aov.is_matte()) => Layers::None,
        aovs if aovs.iter().any(|aov| [Aov::Color, Aov::TexCoord, Aov::Motion].contains(aov)) => {
            Layers::GeometryAndColors
        }
        _ => Layers::Geometry,
    }
}

fn vectors(pixels: &[[f32; 4]]) -> Vec<f32> {
    pixels.iter().flat_map(|&[x, y, z, _]| [x, y, z]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use planish_film::Samples;

    fn parse(text: &str) -> Result<AovList, String> {
        text.parse()
    }

    #[test]
    fn lists_are_names_in_any_case_each_once() {
        assert_eq!(parse("").unwrap().aovs().to_owned(), []);
        assert_eq!(parse("Z,n, uv,z").unwrap().aovs().to_owned(), [Aov::Depth, Aov::Normal, Aov::Uv]);
        let all = parse("z,n,p,uv,face,patch,level,tess,color,st,object,motion,crypto_object,crypto_material").unwrap();
        assert_eq!(all.aovs(), Aov::NAMES.map(|(_, aov)| aov));
    }

    #[test]
    fn unknown_names_are_refused_with_the_known_ones() {
        let message = parse("z,albedo").unwrap_err();
        assert_eq!(
            message,
            "layer albedo is unknown (known: z, n, p, uv, face, patch, level, tess, color, st, object, motion, crypto_object, crypto_material)"
        );
    }

    /// A pixel with a surface and one without.
    fn packed() -> PackedLayers {
        PackedLayers {
            normal_depth: vec![[0.0, 0.6, 0.8, 7.0], [0.0; 4]],
            position_factor: vec![[1.0, 2.0, 3.0, 16.0], [0.0; 4]],
            ids: vec![[5, 3 << PATCH_BITS | 99, 0.25_f32.to_bits(), 0.75_f32.to_bits()], [NO_SURFACE; 4]],
            colors: vec![[2.0, -0.5, 0.25, 1.0], [0.0; 4]],
            motion_st: vec![[1.5, -2.5, 0.1, 0.2], [0.0; 4]],
            first_faces: vec![0, 4, 4, 6],
        }
    }

    #[test]
    fn no_more_is_drawn_than_layers_need() {
        assert_eq!(drawn_layers(&[]), Layers::None);
        assert_eq!(drawn_layers(&[Aov::CryptoObject]), Layers::None);
        assert_eq!(drawn_layers(&[Aov::Depth, Aov::Uv]), Layers::Geometry);
        assert_eq!(drawn_layers(&[Aov::Depth, Aov::Color]), Layers::GeometryAndColors);
    }

    #[test]
    fn layers_unpack_what_the_device_packs() {
        let samples = |aov| packed().layer(aov).unwrap().samples;
        assert_eq!(samples(Aov::Depth), Samples::Float(vec![7.0, f32::INFINITY]));
        assert_eq!(samples(Aov::Normal), Samples::Float(vec![0.0, 0.6, 0.8, 0.0, 0.0, 0.0]));
        assert_eq!(samples(Aov::Position), Samples::Float(vec![1.0, 2.0, 3.0, 0.0, 0.0, 0.0]));
        assert_eq!(samples(Aov::Uv), Samples::Float(vec![0.25, 0.75, 0.0, 0.0]));
        assert_eq!(samples(Aov::Face), Samples::Uint(vec![5, u32::MAX]));
        assert_eq!(samples(Aov::Patch), Samples::Uint(vec![99, u32::MAX]));
        assert_eq!(samples(Aov::Level), Samples::Uint(vec![3, u32::MAX]));
        assert_eq!(samples(Aov::Tess), Samples::Float(vec![16.0, 0.0]));
        assert_eq!(samples(Aov::Color), Samples::Float(vec![2.0, -0.5, 0.25, 0.0, 0.0, 0.0]));
        assert_eq!(samples(Aov::TexCoord), Samples::Float(vec![0.1, 0.2, 0.0, 0.0]));
        assert_eq!(samples(Aov::Motion), Samples::Float(vec![1.5, -2.5, 0.0, 0.0]));
        // Object 1 has no faces.
        assert_eq!(samples(Aov::Object), Samples::Uint(vec![2, u32::MAX]));
    }

    #[test]
    fn channels_have_the_interface_s_names() {
        let names = |aov| packed().layer(aov).unwrap().channel_names().join(" ");
        assert_eq!(
            Aov::NAMES.map(|(_, aov)| aov).into_iter().filter(|aov| !aov.is_matte()).map(names).collect::<Vec<_>>(),
            [
                "Z",
                "N.X N.Y N.Z",
                "P.X P.Y P.Z",
                "uv.x uv.y",
                "face",
                "patch",
                "level",
                "tess",
                "color.R color.G color.B",
                "st.x st.y",
                "object",
                "motion.x motion.y"
            ]
        );
    }
}
