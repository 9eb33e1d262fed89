//! Materials, textures and images.
use std::path::PathBuf;

use crate::common::{File, square};
use planish_scene::{AlphaMode, ImageContent, Material, Texture, TextureRef, Wrap};
use serde_json::{Value, json};

/// The square of a material, with two textures of an embedded image and one of a file.
fn with_material(material: Value) -> File {
    let mut file = square();
    file.add("materials", material);
    file.primitive(0)["material"] = json!(0);
    let uv = file.floats(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    file.primitive(0)["attributes"]["TEXCOORD_0"] = json!(uv);
    file.primitive(0)["attributes"]["TEXCOORD_1"] = json!(uv);
    let view = file.view(b"image");
    file.add("images", json!({ "bufferView": view, "mimeType": "image/png", "name": "inside" }));
    file.add("images", json!({ "uri": "textures/wood%20old.png" }));
    file.add("images", json!({ "uri": "data:image/png;base64,aGk=" }));
    file.add("samplers", json!({ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 }));
    file.add("textures", json!({ "source": 0 }));
    file.add("textures", json!({ "source": 1, "sampler": 0 }));
    file.add("textures", json!({ "extensions": { "KHR_texture_basisu": { "source": 0 } } }));
    file
}

fn material(material: Value) -> Material {
    let mut scene = with_material(material);
    scene.json["textures"].as_array_mut().unwrap().pop();
    scene.scene().materials.remove(0)
}

#[test]
fn a_material_without_anything_is_gltfs_default() {
    let found = material(json!({}));
    let expected = Material {
        name: "material 0".to_owned(),
        base_color: [1.0; 3],
        metallic: 1.0,
        roughness: 1.0,
        double_sided: false,
        ..Material::default()
    };
    assert_eq!(found, expected);
}

#[test]
fn textures_have_their_channels_and_colour_spaces() {
    let found = material(json!({
        "name": "all",
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "baseColorTexture": { "index": 1 },
            "metallicFactor": 0.5, "roughnessFactor": 0.25, "metallicRoughnessTexture": { "index": 0 } },
        "normalTexture": { "index": 0, "scale": 0.5 },
        "occlusionTexture": { "index": 0, "strength": 0.75 },
        "emissiveFactor": [1, 0.5, 0], "emissiveTexture": { "index": 1 },
        "alphaMode": "BLEND", "doubleSided": true,
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 8 } },
    }));
    let (zero, one) = (TextureRef::plain(0), TextureRef::plain(1));
    let srgb = Some(TextureRef { is_srgb: true, ..one.clone() });
    assert_eq!((found.base_color, found.opacity, found.alpha), ([0.1, 0.2, 0.3], 0.4, AlphaMode::Blend));
    assert_eq!((&found.base_color_texture, &found.emissive_texture), (&srgb, &srgb));
    assert_eq!(found.opacity_texture, Some(TextureRef { channel: 3, ..one }));
    assert_eq!((found.metallic, found.roughness, found.occlusion_strength), (0.5, 0.25, 0.75));
    assert_eq!(found.metallic_texture, Some(TextureRef { channel: 2, ..zero.clone() }));
    assert_eq!(found.roughness_texture, Some(TextureRef { channel: 1, ..zero.clone() }));
    assert_eq!(found.occlusion_texture, Some(zero.clone()));
    let normal = TextureRef { scale: [1.0, 1.0, 2.0, 1.0], bias: [-0.5, -0.5, -1.0, 0.0], ..zero };
    assert_eq!(found.normal_texture, Some(normal));
    assert_eq!((found.emissive, found.double_sided), ([8.0, 4.0, 0.0], true));
}

#[test]
fn opacity_is_ignored_unless_asked_for() {
    let of = |mode: &str, cutoff: Value| {
        let found = material(
            json!({ "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": { "index": 0 } },
            "alphaMode": mode, "alphaCutoff": cutoff }),
        );
        (found.alpha, found.opacity, found.opacity_texture.is_some())
    };
    assert_eq!(of("OPAQUE", json!(null)), (AlphaMode::Opaque, 1.0, false));
    assert_eq!(of("MASK", json!(null)), (AlphaMode::Mask(0.5), 0.5, true));
    assert_eq!(of("MASK", json!(0.25)), (AlphaMode::Mask(0.25), 0.5, true));
}

#[test]
fn samplers_and_images_are_kept() {
    let mut file = with_material(json!({}));
    file.json["textures"].as_array_mut().unwrap().pop();
    let scene = file.scene();
    let clamped = Texture { image: 1, wrap: [Wrap::Clamp, Wrap::Mirror], is_nearest: true };
    assert_eq!(scene.textures, [Texture { image: 0, wrap: [Wrap::Repeat; 2], is_nearest: false }, clamped]);
    let images: Vec<_> = scene.images.iter().map(|image| (image.name.as_str(), &image.content)).collect();
    assert_eq!(images[0], ("inside", &ImageContent::Bytes(b"image".to_vec())));
    assert_eq!(images[1], ("wood old.png", &ImageContent::File(PathBuf::from("folder/textures/wood old.png"))));
    assert_eq!(images[2], ("images[2]", &ImageContent::Bytes(b"hi".to_vec())));
}

#[test]
fn textures_are_transformed_wherever_they_are_used() {
    let transform = json!({ "KHR_texture_transform": { "offset": [0.5, 0.25], "scale": [2, 3] } });
    let texture = json!({ "index": 0, "extensions": transform });
    let found = material(json!({
        "pbrMetallicRoughness": { "baseColorTexture": texture, "metallicRoughnessTexture": texture },
        "normalTexture": texture, "occlusionTexture": texture, "emissiveTexture": texture,
    }));
    assert_eq!(found.textures().count(), 6);
    for texture in found.textures() {
        assert_eq!(texture.transform, [[2.0, 0.0, 0.5], [0.0, 3.0, 0.25]]);
    }
}

#[test]
fn other_sets_of_texture_coordinates_are_kept_behind_the_first_and_warned_of_once() {
    let mut file = with_material(
        json!({ "normalTexture": { "index": 0, "texCoord": 1 }, "emissiveTexture": { "index": 0, "texCoord": 1 } }),
    );
    file.json["textures"].as_array_mut().unwrap().pop();
    let text = "materials[0]: texture coordinates of another set than 0: its textures use the mesh' first set";
    assert_eq!(file.warnings(), [text]);
    let names = |file: &File| -> Vec<String> {
        let scene = file.read_with(&planish_scene::LoadOptions::default()).unwrap();
        scene.meshes[0].control_mesh.face_varying.iter().map(|channel| channel.name.clone()).collect()
    };
    assert_eq!(names(&file), ["st", "st1"]);
    file.json["materials"][0] = json!({});
    assert_eq!(names(&file), ["st"]);
}

#[test]
fn textures_of_formats_that_cannot_be_read_are_left_out() {
    let file = with_material(json!({ "emissiveTexture": { "index": 2 } }));
    assert_eq!(file.warnings(), ["textures[2]: no image that can be read: left out"]);
    let scene = file.read_with(&planish_scene::LoadOptions::default()).unwrap();
    assert_eq!(scene.materials[0].emissive_texture, None);
}

#[test]
fn extensions_of_materials_become_what_the_renderer_has() {
    let of = |extensions: Value| {
        material(
            json!({ "pbrMetallicRoughness": { "metallicFactor": 0, "baseColorFactor": [0.5, 0.25, 0, 1] }, "extensions": extensions }),
        )
    };
    assert_eq!(of(json!({ "KHR_materials_ior": { "ior": 1.25 } })).ior, 1.25);
    let dull = of(json!({ "KHR_materials_specular": { "specularFactor": 0 } }));
    assert_eq!((dull.ior, dull.specular), (1.0, None));
    let half = of(json!({ "KHR_materials_specular": { "specularFactor": 0.5 } })).ior;
    assert!((((half - 1.0) / (half + 1.0)).powi(2) - 0.02).abs() < 1e-6);
    let tinted = of(json!({ "KHR_materials_specular": { "specularColorFactor": [1, 0.5, 0] } })).specular.unwrap();
    assert!((tinted[0] - 0.04).abs() < 1e-6 && (tinted[1] - 0.02).abs() < 1e-6 && tinted[2] == 0.0);
    let coat = of(json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.5 } }));
    assert_eq!((coat.clearcoat, coat.clearcoat_roughness), (1.0, 0.5));
    let unlit = of(json!({ "KHR_materials_unlit": {} }));
    assert_eq!((unlit.emissive, unlit.base_color, unlit.specular), ([0.5, 0.25, 0.0], [0.0; 3], Some([0.0; 3])));
}

#[test]
fn numbers_that_no_surface_has_are_refused() {
    for (material, expected) in [
        (
            json!({ "pbrMetallicRoughness": { "metallicFactor": 2 } }),
            "materials[0].metallicFactor: found 2, expected 0 to 1",
        ),
        (
            json!({ "emissiveFactor": [0, -1, 0] }),
            "materials[0]: found -1 as emissive, specular or ior, expected 0 or more",
        ),
        (
            json!({ "emissiveTexture": { "index": 3 } }),
            "materials[0].emissiveTexture: found textures index 3, expected 0 to 2",
        ),
        (json!({ "alphaMode": "GLASS" }), "materials[0]: found an unknown alphaMode, expected OPAQUE, MASK or BLEND"),
    ] {
        assert_eq!(with_material(material).refusal(), expected);
    }
    let mut file = with_material(json!({}));
    file.primitive(0)["material"] = json!(1);
    assert_eq!(file.refusal(), "meshes[0]: found materials index 1, expected 0 to 0");
}
