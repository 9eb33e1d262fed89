//! A scene's materials, lights and environment, made ready to shade frames with; and the shading of a frame, sample by sample.
//!
//! A scene is shaded if it has any of them ([`is_shaded`]); else frames are drawn in the light of `glsl/shared/shading.glsl`. Where
//! there are materials but no light they are seen in the same light.

use std::collections::BTreeMap;

use anyhow::Result;
use glam::{Affine3A, DAffine3, Mat3};
use half::f16;
use planish_gpu::{Device, Encoder};
use planish_render::shading::{
    Alpha, EnvironmentDesc, LightDesc, LightKind, MaterialDesc, ObjectMaterials, SceneSphere, ShadePass, ShadedFrame,
    Shading, ShadingDesc, Shadows, Texels, TextureDesc, TextureUseDesc, TextureWrap, ptex_slots, studio_environment,
    studio_lights,
};
use planish_render::{FrameCamera, FrameNeeds, FrameOptions, FrameStages, Layers, Surface, SurfaceDesc, Targets};
use planish_scene::{
    AlphaMode, DecodedImage, Environment, Light, Material, Pixels, Pose, Scene, TextureRef, Wrap, decode_image,
};

/// How much larger than the cages' box the surface is taken to be: displaced ones leave it.
const SPHERE_MARGIN: f64 = 1.05;

/// Whether a scene has materials or light of its own.
pub fn is_shaded(scene: &Scene) -> bool {
    !scene.materials.is_empty() || has_light(scene)
}

fn has_light(scene: &Scene) -> bool {
    !scene.lights.is_empty() || scene.environment.is_some()
}

/// Adds what the shading of a scene needs to what its frames need.
pub fn add_needs(scene: &Scene, needs: &mut FrameNeeds) {
    needs.cutouts = scene.materials.iter().any(|material| material_desc(material, &[]).has_holes());
    // Lights may see surfaces from nearer than the eye does.
    needs.cuts |= scene.lights.iter().any(|light| light.casts_shadows);
}

/// What shadow maps are drawn with.
pub struct FrameParts<'a> {
    pub device: &'a Device,
    pub surface: &'a mut Surface,
    pub stages: &'a FrameStages,
    pub options: &'a FrameOptions,
}

/// Gives a surface the texture coordinates and colours of a scene's meshes.
pub fn set_channels(device: &Device, surface: &mut Surface, scene: &Scene) -> Result<()> {
    let meshes: Vec<_> = scene.meshes.iter().map(|mesh| &mesh.control_mesh).collect();
    if meshes.iter().any(|mesh| !mesh.face_varying.is_empty()) {
        surface.set_tex_coords(device, &meshes)?;
    }
    Ok(surface.set_colors(device, &meshes)?)
}

/// A scene's materials and lights on a device.
pub struct SceneShading {
    shading: Shading,
    shadows: Shadows,
    pass: ShadePass,
}

impl SceneShading {
    /// Reads the scene's images and uploads its materials. The surface's objects are the scene's instances, in order; it gets texture
    /// coordinates and colours here. `has_ids`: coverage is asked for, by the numbers of instances, and of materials from 1 on. `shadow_map_size`: texels of a
    /// shadow map's side.
    pub fn new(
        device: &Device,
        surface: &mut Surface,
        scene: &Scene,
        needs: &FrameNeeds,
        size: [u32; 2],
        has_ids: bool,
        shadow_map_size: u32,
    ) -> Result<Self> {
        set_channels(device, surface, scene)?;
        let textures = SceneTextures::load(scene)?;
        let materials = (1..)
            .zip(&scene.materials)
            .map(|(id, material)| MaterialDesc { id, ..material_desc(material, &textures.uses) });
        let materials: Vec<MaterialDesc> = materials.collect();
        let face_slots = scene.meshes.iter().map(|mesh| ptex_slots(&mesh.control_mesh, &mesh.face_slots));
        let objects = (0..).zip(&scene.instances).map(|(id, instance)| ObjectMaterials {
            materials: instance.materials.clone(),
            mesh: instance.mesh,
            id,
        });
        let sky = environment_image(scene)?;
        let desc = ShadingDesc {
            textures: &textures.descs(scene),
            materials: &materials,
            face_slots: &face_slots.collect::<Vec<_>>(),
            objects: &objects.collect::<Vec<_>>(),
            environment: environment_desc(scene, sky.as_ref()),
            has_studio: !has_light(scene),
        };
        let shading = Shading::new(device, surface, &desc)?;
        let surface_desc: SurfaceDesc = *surface.desc();
        Ok(Self {
            shading,
            shadows: Shadows::new(device, &surface_desc, needs, shadow_map_size)?,
            pass: ShadePass::new(device, size, has_ids)?,
        })
    }

    /// Starts a frame: nothing is shaded yet.
    pub fn begin(&self, device: &Device) -> Result<()> {
        let mut encoder = Encoder::new(device, "shading")?;
        self.pass.record_clear(&mut encoder);
        device.submit_and_wait(&encoder.finish()?)?;
        Ok(())
    }

    /// Draws the shadow maps of a sample, before its frame is drawn: if it is the frame's first, or lights have an extent or, as `moves`
    /// says, anything has moved since the last sample. The cages are as they were set last. `count`: samples of the frame.
    pub fn draw_shadow_maps(
        &mut self,
        parts: &mut FrameParts<'_>,
        scene: &Scene,
        pose: &Pose,
        (sample, count): (u32, u32),
        moves: bool,
    ) -> Result<()> {
        self.shading.set_sample(sample)?;
        let lights = if has_light(scene) { light_descs(scene, pose) } else { studio_lights() };
        if sample == 0 || moves || Shadows::varies(&lights) {
            // Shadows fall into a part of the image from anywhere.
            let crop = parts.surface.crop();
            parts.surface.set_crop(None);
            let drawn = self.draw_shadows(parts, &lights, &sphere(scene, pose), (count > 1).then_some(sample));
            parts.surface.set_crop(crop);
            drawn?;
        }
        Ok(())
    }

    /// Shades the sample that was drawn into the targets, seen by this camera.
    pub fn shade(&self, device: &Device, targets: &Targets, camera: &FrameCamera, sample: u32) -> Result<()> {
        self.pass.set_sample(camera, &self.shading, &self.shadows, sample)?;
        let mut encoder = Encoder::new(device, "shading")?;
        self.pass.record(&mut encoder, targets, &self.shading, &self.shadows);
        device.submit_and_wait(&encoder.finish()?)?;
        Ok(())
    }

    fn draw_shadows(
        &mut self,
        parts: &mut FrameParts<'_>,
        lights: &[LightDesc],
        sphere: &SceneSphere,
        sample: Option<u32>,
    ) -> Result<()> {
        let FrameParts { device, surface, stages, options, .. } = parts;
        for view in 0..self.shadows.set_lights(device, lights, sphere, sample)? {
            self.shadows.set_frame(surface, view, options)?;
            loop {
                let mut encoder = Encoder::new(device, "shadows")?;
                self.shadows.record(&mut encoder, surface, stages, &self.shading, view);
                device.submit_and_wait(&encoder.finish()?)?;
                if !surface.grow(device)? {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Reads the frame: the mean of its samples.
    pub fn finish(&self, device: &Device, count: u32) -> Result<ShadedFrame> {
        Ok(self.pass.read(device, count)?)
    }
}

/// What a frame is shaded from.
pub const LAYERS: Layers = Layers::Shading;

fn sphere(scene: &Scene, pose: &Pose) -> SceneSphere {
    let bounds = scene.posed_bounds(pose).or_else(|| scene.bounds());
    let (center, radius) = bounds.map_or_else(Default::default, |bounds| {
        (0.5 * (bounds.min + bounds.max), 0.5 * bounds.diagonal() * SPHERE_MARGIN)
    });
    SceneSphere { center: center.as_vec3(), radius: if radius > 0.0 { radius as f32 } else { 1.0 } }
}

fn light_descs(scene: &Scene, pose: &Pose) -> Vec<LightDesc> {
    let kind = |light: &Light| match light.kind {
        planish_scene::LightKind::Distant { angle } => LightKind::Distant { angle },
        planish_scene::LightKind::Point { radius, range } => LightKind::Point { radius, range },
        planish_scene::LightKind::Spot { radius, range, inner, outer } => {
            LightKind::Spot { radius, range, inner, outer }
        }
    };
    let lights = scene.lights.iter().zip(&pose.lights).map(|(light, pose)| LightDesc {
        kind: kind(light),
        to_world: in_single(&pose.to_world),
        intensity: pose.radiance,
        casts_shadows: light.casts_shadows,
    });
    lights.collect()
}

fn in_single(transform: &DAffine3) -> Affine3A {
    Affine3A { matrix3: transform.matrix3.as_mat3().into(), translation: transform.translation.as_vec3().into() }
}

type SkyImage = ([u32; 2], Vec<[f16; 4]>);

/// The environment's image; that of the studio where there is no light.
fn environment_image(scene: &Scene) -> Result<Option<SkyImage>> {
    let Some(environment) = &scene.environment else {
        return Ok((!has_light(scene)).then(studio_environment));
    };
    let Some(image) = environment.image else { return Ok(None) };
    // Of images with 8 bits a channel, encoded as images to look at are.
    let decoded = decode_image(&scene.images[image], true)?;
    Ok(Some(([decoded.width, decoded.height], decoded.into_halves(true))))
}

fn environment_desc<'a>(scene: &Scene, sky: Option<&'a SkyImage>) -> Option<EnvironmentDesc<'a>> {
    let image = sky.map(|(size, texels)| (*size, texels.as_slice()));
    match &scene.environment {
        Some(Environment { color, to_world, is_visible, .. }) => {
            let to_world = to_world.matrix3.as_mat3();
            Some(EnvironmentDesc { image, color: *color, to_world, is_visible: *is_visible })
        }
        None => image.map(|_| EnvironmentDesc { image, color: [1.0; 3], to_world: Mat3::IDENTITY, is_visible: false }),
    }
}

/// A texture and whether it is sRGB.
type TextureKey = (usize, bool);

/// Each texture as often as it is used, with and without decoding, with its image.
struct SceneTextures {
    uses: Vec<TextureKey>,
    images: BTreeMap<TextureKey, DecodedImage>,
}

impl SceneTextures {
    fn load(scene: &Scene) -> Result<Self> {
        let mut uses: Vec<TextureKey> = scene
            .materials
            .iter()
            .flat_map(Material::textures)
            .map(|reference| (reference.texture, reference.is_srgb))
            .collect();
        uses.sort_unstable();
        uses.dedup();
        let mut images = BTreeMap::new();
        for &(texture, is_srgb) in &uses {
            let image = scene.textures[texture].image;
            if let std::collections::btree_map::Entry::Vacant(entry) = images.entry((image, is_srgb)) {
                entry.insert(decode_image(&scene.images[image], is_srgb)?);
            }
        }
        Ok(Self { uses, images })
    }

    fn descs(&self, scene: &Scene) -> Vec<TextureDesc<'_>> {
        let wrap = |wrap: Wrap| match wrap {
            Wrap::Repeat => TextureWrap::Repeat,
            Wrap::Mirror => TextureWrap::Mirror,
            Wrap::Clamp => TextureWrap::Clamp,
            Wrap::Black => TextureWrap::Black,
        };
        let desc = |&(texture, is_srgb): &TextureKey| {
            let texture = &scene.textures[texture];
            let image = &self.images[&(texture.image, is_srgb)];
            TextureDesc {
                size: [image.width, image.height],
                texels: match &image.pixels {
                    Pixels::Bytes(texels) => Texels::Bytes { texels, is_srgb },
                    Pixels::Halves(texels) => Texels::Halves(texels),
                },
                wrap: texture.wrap.map(wrap),
                is_nearest: texture.is_nearest,
            }
        };
        self.uses.iter().map(desc).collect()
    }
}

/// A material with its textures' places among those that are used; textures that are not are left out.
fn material_desc(material: &Material, uses: &[TextureKey]) -> MaterialDesc {
    let texture = |reference: &Option<TextureRef>| {
        let reference = reference.as_ref()?;
        let texture = uses.binary_search(&(reference.texture, reference.is_srgb)).ok()?;
        let TextureRef { channel, transform, scale, bias, .. } = *reference;
        Some(TextureUseDesc { texture, channel, transform, scale, bias })
    };
    MaterialDesc {
        base_color: material.base_color,
        opacity: material.opacity,
        alpha: match material.alpha {
            AlphaMode::Opaque => Alpha::Opaque,
            AlphaMode::Mask(threshold) => Alpha::Mask(threshold),
            AlphaMode::Blend => Alpha::Blend,
        },
        metallic: material.metallic,
        roughness: material.roughness,
        emissive: material.emissive,
        ior: material.ior,
        specular: material.specular,
        clearcoat: material.clearcoat,
        clearcoat_roughness: material.clearcoat_roughness,
        occlusion_strength: material.occlusion_strength,
        double_sided: material.double_sided,
        id: 0,
        textures: [
            texture(&material.base_color_texture),
            texture(&material.opacity_texture),
            texture(&material.metallic_texture),
            texture(&material.roughness_texture),
            texture(&material.normal_texture),
            texture(&material.occlusion_texture),
            texture(&material.emissive_texture),
        ],
    }
}

#[cfg(test)]
mod tests {
    use planish_scene::{ImageContent, ImageSource, Texture};

    use super::*;

    fn textured_scene() -> Scene {
        let image = |name: &str| ImageSource { name: name.to_owned(), content: ImageContent::Bytes(vec![0]) };
        Scene {
            images: vec![image("a"), image("b")],
            textures: vec![Texture { image: 1, wrap: [Wrap::Clamp; 2], is_nearest: true }],
            ..Scene::default()
        }
    }

    #[test]
    fn a_texture_that_is_used_decoded_and_not_is_two() {
        let mut scene = textured_scene();
        let srgb = TextureRef { is_srgb: true, ..TextureRef::plain(0) };
        scene.materials = vec![Material {
            base_color_texture: Some(srgb.clone()),
            emissive_texture: Some(srgb),
            roughness_texture: Some(TextureRef { channel: 1, ..TextureRef::plain(0) }),
            ..Material::default()
        }];
        let uses = [(0, false), (0, true)];
        let desc = material_desc(&scene.materials[0], &uses);
        let places = desc.textures.map(|texture| texture.map(|texture| (texture.texture, texture.channel)));
        assert_eq!(places, [Some((1, 0)), None, None, Some((0, 1)), None, None, Some((1, 0))]);
        let message = SceneTextures::load(&scene).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(message.starts_with("image b: found a file of unknown format"), "{message}");
    }

    #[test]
    fn a_material_keeps_all_that_it_says() {
        let reference = |texture: usize| TextureRef {
            texture,
            channel: texture as u32 % 4,
            is_srgb: false,
            transform: [[2.0, 0.5, 0.25], [-0.5, 3.0, texture as f32]],
            scale: [2.0; 4],
            bias: [-1.0; 4],
        };
        let used = |texture: usize| {
            let TextureRef { channel, transform, scale, bias, .. } = reference(texture);
            Some(TextureUseDesc { texture, channel, transform, scale, bias })
        };
        let material = Material {
            name: "all".to_owned(),
            base_color: [0.1, 0.2, 0.3],
            base_color_texture: Some(reference(0)),
            opacity: 0.4,
            opacity_texture: Some(reference(1)),
            alpha: AlphaMode::Mask(0.3),
            metallic: 0.6,
            metallic_texture: Some(reference(2)),
            roughness: 0.7,
            roughness_texture: Some(reference(3)),
            normal_texture: Some(reference(4)),
            occlusion_texture: Some(reference(5)),
            occlusion_strength: 0.8,
            emissive: [4.0, 5.0, 6.0],
            emissive_texture: Some(reference(6)),
            ior: 1.7,
            specular: Some([0.01, 0.02, 0.03]),
            clearcoat: 0.9,
            clearcoat_roughness: 0.15,
            double_sided: false,
        };
        let expected = MaterialDesc {
            base_color: [0.1, 0.2, 0.3],
            opacity: 0.4,
            alpha: Alpha::Mask(0.3),
            metallic: 0.6,
            roughness: 0.7,
            emissive: [4.0, 5.0, 6.0],
            ior: 1.7,
            specular: Some([0.01, 0.02, 0.03]),
            clearcoat: 0.9,
            clearcoat_roughness: 0.15,
            occlusion_strength: 0.8,
            double_sided: false,
            id: 0,
            textures: std::array::from_fn(used),
        };
        let uses: Vec<TextureKey> = (0..7).map(|texture| (texture, false)).collect();
        assert_eq!(material_desc(&material, &uses), expected);
    }

    #[test]
    fn textures_keep_their_wraps_and_are_decoded_where_they_are_colours() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        // Half of the light is 188 of 255.
        let film =
            planish_film::Film { width: 2, height: 1, color: vec![[0.5, 0.5, 0.5, 1.0]; 2], ..Default::default() };
        planish_film::write_png(&film, &path).unwrap();
        let content = ImageContent::File(path);
        let reference = |is_srgb| Some(TextureRef { is_srgb, ..TextureRef::plain(0) });
        let scene = Scene {
            images: vec![ImageSource { name: "a".to_owned(), content }],
            textures: vec![Texture { image: 0, wrap: [Wrap::Mirror, Wrap::Black], is_nearest: true }],
            materials: vec![Material {
                base_color_texture: reference(true),
                normal_texture: reference(false),
                ..Material::default()
            }],
            ..Scene::default()
        };
        let textures = SceneTextures::load(&scene).unwrap();
        let descs = textures.descs(&scene);
        assert_eq!(descs.len(), 2);
        for (desc, expected) in descs.iter().zip([false, true]) {
            assert_eq!((desc.size, desc.wrap), ([2, 1], [TextureWrap::Mirror, TextureWrap::Black]));
            let Texels::Bytes { texels, is_srgb } = desc.texels else { panic!("bytes") };
            assert_eq!((texels, is_srgb, desc.is_nearest), ([[188, 188, 188, 255]; 2].as_slice(), expected, true));
        }
    }

    /// A PNG image of one grey texel of 16 bits: half of what they hold.
    const DEEP_GREY: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x10\0\0\0\0j\xeeG\x16\
        \0\0\0\x0eIDATx\x01\x01\x03\0\xfc\xff\0\x80\0\x01\x03\0\x81\xe1\xb3\x15c\0\0\0\0IEND\xaeB`\x82";

    #[test]
    fn texels_of_16_bits_are_light_where_they_are_colours_and_numbers_where_not() {
        let content = ImageContent::Bytes(DEEP_GREY.to_vec());
        let reference = |is_srgb| Some(TextureRef { is_srgb, ..TextureRef::plain(0) });
        let mut scene = textured_scene();
        scene.images[1].content = content;
        scene.materials = vec![Material {
            base_color_texture: reference(true),
            normal_texture: reference(false),
            ..Material::default()
        }];
        let textures = SceneTextures::load(&scene).unwrap();
        for (desc, expected) in textures.descs(&scene).iter().zip([0.5, 0.214]) {
            let Texels::Halves(texels) = desc.texels else { panic!("halves") };
            assert!((texels[0][0].to_f32() - expected).abs() < 1e-3, "{texels:?}, expected {expected}");
        }
    }

    #[test]
    fn a_scene_without_materials_and_light_is_not_shaded() {
        let mut scene = Scene::default();
        assert!(!is_shaded(&scene));
        scene.materials.push(Material::default());
        assert!(is_shaded(&scene) && !has_light(&scene));
        let sky = environment_image(&scene).unwrap();
        assert!(environment_desc(&scene, sky.as_ref()).is_some_and(|sky| !sky.is_visible));
    }

    #[test]
    fn holes_are_needed_for_masks_and_single_sides() {
        let mut needs = FrameNeeds::all(planish_render::Spacing::Equal);
        let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
        add_needs(&scene, &mut needs);
        assert!(!needs.cutouts);
        for material in [
            Material { alpha: AlphaMode::Mask(0.5), ..Material::default() },
            Material { double_sided: false, ..Material::default() },
        ] {
            scene.materials = vec![Material::default(), material];
            needs.cutouts = false;
            add_needs(&scene, &mut needs);
            assert!(needs.cutouts);
        }
    }
}
