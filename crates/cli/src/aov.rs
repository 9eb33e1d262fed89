//! Layers beside the colour: their names, and what they hold.

use std::str::FromStr;

use anyhow::bail;
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
}

impl Aov {
    /// Every layer with its name.
    const NAMES: [(&'static str, Self); 9] = [
        ("z", Self::Depth),
        ("n", Self::Normal),
        ("p", Self::Position),
        ("uv", Self::Uv),
        ("face", Self::Face),
        ("patch", Self::Patch),
        ("level", Self::Level),
        ("tess", Self::Tess),
        ("color", Self::Color),
    ];

    /// Layers of the interface that do not exist yet.
    const TO_COME: [&'static str; 2] = ["object", "motion"];
}

/// Comma-separated names of layers, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AovList {
    aovs: Vec<Aov>,
    to_come: Option<String>,
}

impl AovList {
    /// The layers asked for; refused where one does not exist yet.
    pub fn available(&self) -> anyhow::Result<&[Aov]> {
        match &self.to_come {
            Some(name) => bail!("layer {name} is not available yet (available: {})", known_names()),
            None => Ok(&self.aovs),
        }
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
            if Aov::TO_COME.contains(&name.as_str()) {
                list.to_come = Some(name);
                continue;
            }
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
}

impl PackedLayers {
    /// The layer of an AOV. Where there is no surface floats are 0, but the depth is infinite, and ids are `u32::MAX`.
    pub fn layer(&self, aov: Aov) -> Layer {
        match aov {
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
        }
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
        [] => Layers::None,
        aovs if aovs.contains(&Aov::Color) => Layers::GeometryAndColors,
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
        assert_eq!(parse("").unwrap().available().unwrap(), []);
        assert_eq!(parse("Z,n, uv,z").unwrap().available().unwrap(), [Aov::Depth, Aov::Normal, Aov::Uv]);
        let all = parse("z,n,p,uv,face,patch,level,tess,color").unwrap();
        assert_eq!(all.available().unwrap(), Aov::NAMES.map(|(_, aov)| aov));
    }

    #[test]
    fn unknown_names_are_refused_with_the_known_ones() {
        let message = parse("z,albedo").unwrap_err();
        assert_eq!(message, "layer albedo is unknown (known: z, n, p, uv, face, patch, level, tess, color)");
    }

    #[test]
    fn names_to_come_are_refused_when_asked_for() {
        let message = parse("z,motion").unwrap().available().unwrap_err().to_string();
        assert!(message.starts_with("layer motion is not available yet"), "{message}");
    }

    /// A pixel with a surface and one without.
    fn packed() -> PackedLayers {
        PackedLayers {
            normal_depth: vec![[0.0, 0.6, 0.8, 7.0], [0.0; 4]],
            position_factor: vec![[1.0, 2.0, 3.0, 16.0], [0.0; 4]],
            ids: vec![[5, 3 << PATCH_BITS | 99, 0.25_f32.to_bits(), 0.75_f32.to_bits()], [NO_SURFACE; 4]],
            colors: vec![[2.0, -0.5, 0.25, 1.0], [0.0; 4]],
        }
    }

    #[test]
    fn no_more_is_drawn_than_layers_need() {
        assert_eq!(drawn_layers(&[]), Layers::None);
        assert_eq!(drawn_layers(&[Aov::Depth, Aov::Uv]), Layers::Geometry);
        assert_eq!(drawn_layers(&[Aov::Depth, Aov::Color]), Layers::GeometryAndColors);
    }

    #[test]
    fn layers_unpack_what_the_device_packs() {
        let samples = |aov| packed().layer(aov).samples;
        assert_eq!(samples(Aov::Depth), Samples::Float(vec![7.0, f32::INFINITY]));
        assert_eq!(samples(Aov::Normal), Samples::Float(vec![0.0, 0.6, 0.8, 0.0, 0.0, 0.0]));
        assert_eq!(samples(Aov::Position), Samples::Float(vec![1.0, 2.0, 3.0, 0.0, 0.0, 0.0]));
        assert_eq!(samples(Aov::Uv), Samples::Float(vec![0.25, 0.75, 0.0, 0.0]));
        assert_eq!(samples(Aov::Face), Samples::Uint(vec![5, u32::MAX]));
        assert_eq!(samples(Aov::Patch), Samples::Uint(vec![99, u32::MAX]));
        assert_eq!(samples(Aov::Level), Samples::Uint(vec![3, u32::MAX]));
        assert_eq!(samples(Aov::Tess), Samples::Float(vec![16.0, 0.0]));
        assert_eq!(samples(Aov::Color), Samples::Float(vec![2.0, -0.5, 0.25, 0.0, 0.0, 0.0]));
    }

    #[test]
    fn channels_have_the_interface_s_names() {
        let names = |aov| packed().layer(aov).channel_names().join(" ");
        assert_eq!(
            Aov::NAMES.map(|(_, aov)| names(aov)),
            [
                "Z",
                "N.X N.Y N.Z",
                "P.X P.Y P.Z",
                "uv.x uv.y",
                "face",
                "patch",
                "level",
                "tess",
                "color.R color.G color.B"
            ]
        );
    }
}
