//! Metallic-roughness materials, with the extensions that fit the renderer's (docs: formats).
use std::collections::BTreeSet;

use ::gltf::json::Material as FileMaterial;
use ::gltf::json::extensions::material as extension;
use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::material::{AlphaMode as FileAlphaMode, NormalTexture, OcclusionTexture};
use ::gltf::json::texture::Info;
use ::gltf::json::validation::Checked;
use serde_json::{Map, Value};

use super::data::Data;
use super::fault::{Fault, at};
use super::textures::{Textures, Use};
use crate::obj::Warnings;
use crate::{AlphaMode, Material, TextureRef};

/// Reflectance at normal incidence that no index of refraction exceeds here.
const GREATEST_REFLECTANCE: f32 = 0.99;

/// The materials of a file, in its order.
pub struct Materials {
    pub materials: Vec<Material>,
    /// The sets of texture coordinates that each uses.
    sets: Vec<BTreeSet<u32>>,
}

impl Materials {
    /// Reads all materials.
    pub fn read(data: &Data, textures: &Textures, warnings: &mut Warnings) -> Result<Self, Fault> {
        let mut read = Self { materials: Vec::new(), sets: Vec::new() };
        for (index, material) in data.root.materials.iter().enumerate() {
            let place = format!("materials[{index}]");
            let mut reader =
                Reader { material, textures, place: &place, sets: BTreeSet::new(), warnings: &mut *warnings };
            let material = reader.material(index)?;
            if reader.sets.iter().any(|&set| set != 0) {
                let text = "texture coordinates of another set than 0: its textures use the mesh' first set";
                reader.warnings.push(None, format!("{place}: {text}"));
            }
            read.sets.push(reader.sets);
            read.materials.push(material);
        }
        Ok(read)
    }

    /// The sets of texture coordinates that a material of the file uses.
    pub fn texcoord_sets(&self, material: usize) -> BTreeSet<u32> {
        self.sets.get(material).cloned().unwrap_or_default()
    }

    /// Refuses a material that the file does not have.
    pub fn check(&self, material: Option<usize>, place: &str) -> Result<(), Fault> {
        material.map_or(Ok(()), |index| at(&self.materials, index, "materials", || place.to_owned()).map(|_| ()))
    }

    /// The name of a slot for a material.
    pub fn slot_name(&self, material: Option<usize>) -> String {
        material.and_then(|index| self.materials.get(index)).map_or_else(String::new, |material| material.name.clone())
    }
}

struct Reader<'a> {
    material: &'a FileMaterial,
    textures: &'a Textures,
    place: &'a str,
    sets: BTreeSet<u32>,
    warnings: &'a mut Warnings,
}

impl Reader<'_> {
    fn material(&mut self, index: usize) -> Result<Material, Fault> {
        let file = self.material;
        let pbr = &file.pbr_metallic_roughness;
        let [red, green, blue, opacity] = pbr.base_color_factor.0;
        let alpha = self.alpha()?;
        let base = self.info(pbr.base_color_texture.as_ref(), "baseColorTexture")?;
        let metallic_roughness = self.info(pbr.metallic_roughness_texture.as_ref(), "metallicRoughnessTexture")?;
        let emissive_texture = self.info(file.emissive_texture.as_ref(), "emissiveTexture")?;
        let is_see_through = alpha != AlphaMode::Opaque;
        let mut material = Material {
            name: file.name.clone().filter(|name| !name.is_empty()).unwrap_or_else(|| format!("material {index}")),
            base_color: [red, green, blue],
            base_color_texture: base.clone().map(in_srgb),
            opacity: if is_see_through { opacity } else { 1.0 },
            opacity_texture: base.filter(|_| is_see_through).map(|base| TextureRef { channel: 3, ..base }),
            alpha,
            metallic: pbr.metallic_factor.0,
            metallic_texture: metallic_roughness.clone().map(|texture| TextureRef { channel: 2, ..texture }),
            roughness: pbr.roughness_factor.0,
            roughness_texture: metallic_roughness.map(|texture| TextureRef { channel: 1, ..texture }),
            normal_texture: file.normal_texture.as_ref().map(|texture| self.normal(texture)).transpose()?.flatten(),
            occlusion_texture: file
                .occlusion_texture
                .as_ref()
                .map(|texture| self.occlusion(texture))
                .transpose()?
                .flatten(),
            occlusion_strength: file.occlusion_texture.as_ref().map_or(1.0, |texture| texture.strength.0),
            emissive: file.emissive_factor.0,
            emissive_texture: emissive_texture.map(in_srgb),
            double_sided: file.double_sided,
            ..Material::default()
        };
        if let Some(extensions) = &file.extensions {
            self.extend(&mut material, extensions)?;
        }
        self.check(&material)?;
        Ok(material)
    }

    fn alpha(&self) -> Result<AlphaMode, Fault> {
        match self.material.alpha_mode {
            Checked::Valid(FileAlphaMode::Opaque) => Ok(AlphaMode::Opaque),
            Checked::Valid(FileAlphaMode::Mask) => {
                Ok(AlphaMode::Mask(self.material.alpha_cutoff.unwrap_or_default().0))
            }
            Checked::Valid(FileAlphaMode::Blend) => Ok(AlphaMode::Blend),
            Checked::Invalid => Err(Fault::new(self.place, "an unknown alphaMode", "OPAQUE, MASK or BLEND")),
        }
    }

    fn info(&mut self, info: Option<&Info>, name: &str) -> Result<Option<TextureRef>, Fault> {
        let Some(info) = info else { return Ok(None) };
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref());
        self.refer(&Use { texture: info.index.value(), texcoord_set: info.tex_coord, transform }, name)
    }

    fn refer(&mut self, used: &Use, name: &str) -> Result<Option<TextureRef>, Fault> {
        self.sets.insert(used.transform.and_then(|transform| transform.tex_coord).unwrap_or(used.texcoord_set));
        self.textures.refer(used, &format!("{}.{name}", self.place))
    }

    /// Tangent-space normals: x to the right in the image, y up.
    fn normal(&mut self, normal: &NormalTexture) -> Result<Option<TextureRef>, Fault> {
        let transform = normal.extensions.as_ref().and_then(|extensions| transform_of(&extensions.others));
        let used = Use { texture: normal.index.value(), texcoord_set: normal.tex_coord, transform: transform.as_ref() };
        if !normal.scale.is_finite() {
            return Err(Fault::new(self.place, format!("a normal scale of {}", normal.scale), "a finite number"));
        }
        let scale = normal.scale;
        Ok(self.refer(&used, "normalTexture")?.map(|texture| TextureRef {
            scale: [2.0 * scale, 2.0 * scale, 2.0, 1.0],
            bias: [-scale, -scale, -1.0, 0.0],
            ..texture
        }))
    }

    fn occlusion(&mut self, occlusion: &OcclusionTexture) -> Result<Option<TextureRef>, Fault> {
        let transform = occlusion.extensions.as_ref().and_then(|extensions| transform_of(&extensions.others));
        let used =
            Use { texture: occlusion.index.value(), texcoord_set: occlusion.tex_coord, transform: transform.as_ref() };
        self.refer(&used, "occlusionTexture")
    }

    fn extend(&mut self, material: &mut Material, extensions: &extension::Material) -> Result<(), Fault> {
        if let Some(strength) = &extensions.emissive_strength {
            material.emissive = material.emissive.map(|value| value * strength.emissive_strength.0);
        }
        if let Some(ior) = &extensions.ior {
            material.ior = ior.ior.0;
        }
        if let Some(specular) = &extensions.specular {
            self.specular(material, specular);
        }
        if let Some(coat) = extensions.others.get("KHR_materials_clearcoat").and_then(Value::as_object) {
            let number = |name| coat.get(name).and_then(Value::as_f64).unwrap_or_default() as f32;
            material.clearcoat = number("clearcoatFactor");
            material.clearcoat_roughness = number("clearcoatRoughnessFactor");
            if coat.keys().any(|name| name.ends_with("Texture")) {
                self.warnings.push(None, format!("{}: textures of the clearcoat: ignored", self.place));
            }
        }
        if extensions.unlit.is_some() {
            material.emissive = std::mem::take(&mut material.base_color);
            material.emissive_texture = material.base_color_texture.take();
            (material.metallic, material.roughness, material.clearcoat) = (0.0, 1.0, 0.0);
            (material.metallic_texture, material.roughness_texture, material.normal_texture) = (None, None, None);
            material.specular = Some([0.0; 3]);
        }
        Ok(())
    }

    /// KHR_materials_specular scales a dielectric's reflectance. A grey scale is an index of refraction; a colour is kept where
    /// nothing is metal.
    fn specular(&mut self, material: &mut Material, specular: &extension::Specular) {
        if specular.specular_texture.is_some() || specular.specular_color_texture.is_some() {
            self.warnings.push(None, format!("{}: textures of KHR_materials_specular: ignored", self.place));
        }
        let reflectance = ((material.ior - 1.0) / (material.ior + 1.0)).powi(2);
        let color = specular.specular_color_factor.0.map(|c| (reflectance * c).min(1.0) * specular.specular_factor.0);
        let [red, green, blue] = color;
        if red == green && green == blue {
            material.ior = index_of_refraction(red);
        } else if material.metallic == 0.0 {
            material.specular = Some(color);
        } else {
            self.warnings.push(
                None,
                format!("{}: the colour of KHR_materials_specular on a metal: its mean is taken", self.place),
            );
            material.ior = index_of_refraction((red + green + blue) / 3.0);
        }
    }

    /// Refuses numbers that no surface has.
    fn check(&self, material: &Material) -> Result<(), Fault> {
        let shares = [
            ("baseColorFactor", material.base_color[0]),
            ("baseColorFactor", material.base_color[1]),
            ("baseColorFactor", material.base_color[2]),
            ("baseColorFactor", material.opacity),
            ("metallicFactor", material.metallic),
            ("roughnessFactor", material.roughness),
            ("occlusionTexture.strength", material.occlusion_strength),
            ("clearcoatFactor", material.clearcoat),
            ("clearcoatRoughnessFactor", material.clearcoat_roughness),
        ];
        if let Some((name, value)) = shares.into_iter().find(|(_, value)| !(0.0..=1.0).contains(value)) {
            return Err(Fault::new(format!("{}.{name}", self.place), value.to_string(), "0 to 1"));
        }
        let mut amounts =
            material.emissive.into_iter().chain(material.specular.into_iter().flatten()).chain([material.ior]);
        if let Some(value) = amounts.find(|value| !(value.is_finite() && *value >= 0.0)) {
            return Err(Fault::new(self.place, format!("{value} as emissive, specular or ior"), "0 or more"));
        }
        match material.alpha {
            AlphaMode::Mask(cutoff) if !(cutoff.is_finite() && cutoff >= 0.0) => {
                Err(Fault::new(format!("{}.alphaCutoff", self.place), cutoff.to_string(), "0 or more"))
            }
            _ => Ok(()),
        }
    }
}

fn in_srgb(texture: TextureRef) -> TextureRef {
    TextureRef { is_srgb: true, ..texture }
}

/// The index of refraction of a dielectric that reflects this share at normal incidence.
fn index_of_refraction(reflectance: f32) -> f32 {
    let root = reflectance.clamp(0.0, GREATEST_REFLECTANCE).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// The transform where the crate leaves it as it is.
fn transform_of(others: &Map<String, Value>) -> Option<TextureTransform> {
    serde_json::from_value(others.get("KHR_texture_transform")?.clone()).ok()
}
