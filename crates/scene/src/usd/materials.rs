//! Materials (UsdPreviewSurface), and which of them a prim is bound to.
use std::collections::HashMap;

use glam::DVec3;
use openusd::usd;

use super::attributes::Attributes;
use super::convert;
use super::guard::Stage;
use super::network::{self, Source};
use super::textures::Textures;
use super::walk::Tree;
use crate::gltf::fault::Fault;
use crate::obj::Warnings;
use crate::{AlphaMode, Material, TextureRef};

const BINDINGS: [&str; 2] = ["material:binding:preview", "material:binding"];

/// Materials that are bound, each once.
pub struct Materials<'a> {
    stage: &'a Stage,
    pub textures: Textures,
    pub materials: Vec<Material>,
    /// Texture coordinates that each names.
    pub uv_names: Vec<Option<String>>,
    known: HashMap<String, Option<usize>>,
}

/// Reads one shader's inputs.
struct Surface<'a, 'b> {
    stage: &'a Stage,
    shader: &'b usd::Prim,
    textures: &'b mut Textures,
    uv_name: Option<String>,
}

impl<'a> Materials<'a> {
    pub fn new(stage: &'a Stage) -> Self {
        Self {
            stage,
            textures: Textures::default(),
            materials: Vec::new(),
            uv_names: Vec::new(),
            known: HashMap::new(),
        }
    }

    /// What a prim is bound to itself.
    pub fn own(&mut self, prim: &usd::Prim, warnings: &mut Warnings) -> Result<Option<usize>, Fault> {
        for name in BINDINGS {
            if let Some(target) = Attributes::new(prim, 1.0).targets(name)?.into_iter().next() {
                return self.material(&target, warnings);
            }
        }
        Ok(None)
    }

    /// What an item is bound to, itself or by its parents.
    pub fn bound(&mut self, tree: &Tree, item: usize, warnings: &mut Warnings) -> Result<Option<usize>, Fault> {
        for item in std::iter::successors(Some(item), |&item| tree.items[item].parent) {
            if let Some(material) = self.own(&tree.items[item].prim, warnings)? {
                return Ok(Some(material));
            }
        }
        Ok(None)
    }

    /// The material that has a colour and nothing else.
    pub fn plain(&mut self, color: [f32; 3]) -> usize {
        let name = format!("displayColor {} {} {}", color[0], color[1], color[2]);
        if let Some(&Some(material)) = self.known.get(&name) {
            return material;
        }
        let material = Material { name: name.clone(), base_color: color, ..Material::default() };
        self.known.insert(name, Some(self.materials.len()));
        self.uv_names.push(None);
        self.materials.push(material);
        self.materials.len() - 1
    }

    fn material(&mut self, path: &str, warnings: &mut Warnings) -> Result<Option<usize>, Fault> {
        if let Some(&known) = self.known.get(path) {
            return Ok(known);
        }
        let prim = self.stage.prim(path)?;
        let surface = network::source(self.stage, &prim, "outputs:surface")?;
        let made = match surface {
            Source::Output(shader, _) if network::identifier(&shader)? == "UsdPreviewSurface" => {
                let name = path.rsplit('/').next().unwrap_or_default().to_owned();
                let (stage, textures) = (self.stage, &mut self.textures);
                let mut surface = Surface { stage, shader: &shader, textures, uv_name: None };
                let material = surface.read(name)?;
                self.uv_names.push(surface.uv_name);
                self.materials.push(material);
                Some(self.materials.len() - 1)
            }
            _ => {
                warnings.push(None, format!("{path}: no UsdPreviewSurface: the default material"));
                None
            }
        };
        self.known.insert(path.to_owned(), made);
        Ok(made)
    }
}

impl Surface<'_, '_> {
    fn read(&mut self, name: String) -> Result<Material, Fault> {
        let fallback = Material::default();
        let (base_color, base_color_texture) = self.color("diffuseColor", fallback.base_color)?;
        let (emissive, emissive_texture) = self.color("emissiveColor", [0.0; 3])?;
        let (metallic, metallic_texture) = self.scalar("metallic", 0.0)?;
        let (roughness, roughness_texture) = self.scalar("roughness", 0.5)?;
        let (opacity, opacity_texture) = self.scalar("opacity", 1.0)?;
        let (_, occlusion_texture) = self.scalar("occlusion", 1.0)?;
        let threshold = self.number("opacityThreshold", 0.0)?;
        let alpha = match (threshold > 0.0, opacity < 1.0 || opacity_texture.is_some()) {
            (true, _) => AlphaMode::Mask(threshold),
            (false, true) => AlphaMode::Blend,
            (false, false) => AlphaMode::Opaque,
        };
        let is_specular = network::value(self.stage, self.shader, "useSpecularWorkflow", convert::number)?;
        let is_specular = is_specular.unwrap_or(0.0) != 0.0;
        let specular = if is_specular { Some(self.color("specularColor", [0.0; 3])?.0) } else { None };
        Ok(Material {
            name,
            base_color,
            base_color_texture,
            opacity,
            opacity_texture,
            alpha,
            metallic: if is_specular { 0.0 } else { metallic },
            metallic_texture: metallic_texture.filter(|_| !is_specular),
            roughness,
            roughness_texture,
            normal_texture: self.texture("normal", false)?,
            occlusion_texture,
            emissive,
            emissive_texture,
            specular,
            ior: self.number("ior", fallback.ior)?,
            clearcoat: self.number("clearcoat", 0.0)?,
            clearcoat_roughness: self.number("clearcoatRoughness", 0.01)?,
            ..fallback
        })
    }

    /// A colour and its texture, which is instead of it: the factor is then 1.
    fn color(&mut self, name: &str, fallback: [f32; 3]) -> Result<([f32; 3], Option<TextureRef>), Fault> {
        if let Some(texture) = self.texture(name, true)? {
            return Ok(([1.0; 3], Some(texture)));
        }
        let color = network::value(self.stage, self.shader, name, convert::vec3)?;
        let color = color.filter(|color| color.is_finite() && color.min_element() >= 0.0);
        Ok((color.map_or(fallback, |color: DVec3| color.as_vec3().to_array()), None))
    }

    fn scalar(&mut self, name: &str, fallback: f32) -> Result<(f32, Option<TextureRef>), Fault> {
        if let Some(texture) = self.texture(name, false)? {
            return Ok((1.0, Some(texture)));
        }
        Ok((self.number(name, fallback)?, None))
    }

    fn number(&self, name: &str, fallback: f32) -> Result<f32, Fault> {
        let number = network::value(self.stage, self.shader, name, convert::number)?;
        Ok(number.filter(|v| v.is_finite() && *v >= 0.0).map_or(fallback, |v| v as f32))
    }

    fn texture(&mut self, name: &str, is_color: bool) -> Result<Option<TextureRef>, Fault> {
        let source = network::source(self.stage, self.shader, &format!("inputs:{name}"))?;
        let Source::Output(shader, output) = source else { return Ok(None) };
        let made = network::texture(self.stage, (&shader, &output), is_color, self.textures)?;
        Ok(made.map(|(texture, uv_name)| {
            self.uv_name.get_or_insert(uv_name);
            texture
        }))
    }
}
