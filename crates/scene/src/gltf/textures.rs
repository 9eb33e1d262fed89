//! Textures and images. Images are not decoded here.
use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::texture::{MagFilter, Sampler, WrappingMode};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Image, Texture as FileTexture};

use super::data::Data;
use super::fault::{Fault, at};
use super::uri::{Target, follow};
use crate::obj::Warnings;
use crate::{ImageContent, ImageSource, Texture, TextureRef, Wrap};

/// The textures of a file.
#[derive(Default)]
pub struct Textures {
    pub textures: Vec<Texture>,
    pub images: Vec<ImageSource>,
    /// Into `textures`, of every texture of the file; none for those without an image.
    index_of: Vec<Option<usize>>,
}

/// A use of a texture as the file says it: `textureInfo` and its kin.
pub struct Use<'a> {
    pub texture: usize,
    pub texcoord_set: u32,
    pub transform: Option<&'a TextureTransform>,
}

impl Textures {
    /// Reads all textures and images.
    pub fn read(data: &Data, warnings: &mut Warnings) -> Result<Self, Fault> {
        let images = data.root.images.iter().enumerate();
        let images = images.map(|(index, file_image)| image(data, file_image, index)).collect::<Result<_, _>>()?;
        let mut read = Self { images, ..Self::default() };
        for (index, texture) in data.root.textures.iter().enumerate() {
            // What the crate makes of a texture without a source: its image is that of an extension.
            if texture.source.value() == u32::MAX as usize {
                warnings.push(None, format!("textures[{index}]: no image that can be read: left out"));
                read.index_of.push(None);
                continue;
            }
            read.index_of.push(Some(read.textures.len()));
            read.textures.push(texture_of(data, texture, index)?);
        }
        Ok(read)
    }

    /// A reference to a texture; none if it has no image.
    pub fn refer(&self, used: &Use, place: &str) -> Result<Option<TextureRef>, Fault> {
        let index = *at(&self.index_of, used.texture, "textures", || place.to_owned())?;
        let transform = used.transform.map(rows);
        if transform.is_some_and(|rows| !rows.as_flattened().iter().all(|value| value.is_finite())) {
            return Err(Fault::new(place, "a KHR_texture_transform that is not finite", "finite numbers"));
        }
        Ok(index.map(|index| {
            let plain = TextureRef::plain(index);
            TextureRef { transform: transform.unwrap_or(plain.transform), ..plain }
        }))
    }
}

/// Offset * rotation * scale. The rotation is counter-clockwise as seen in the image, where t runs down.
fn rows(transform: &TextureTransform) -> [[f32; 3]; 2] {
    let ([x, y], [s, t]) = (transform.offset.0, transform.scale.0);
    let (sin, cos) = f64::from(transform.rotation.0).sin_cos();
    let (sin, cos) = (sin as f32, cos as f32);
    [[cos * s, sin * t, x], [-sin * s, cos * t, y]]
}

fn texture_of(data: &Data, texture: &FileTexture, index: usize) -> Result<Texture, Fault> {
    let place = || format!("textures[{index}]");
    at(&data.root.images, texture.source.value(), "images", place)?;
    let default = Sampler::default();
    let sampler = match texture.sampler {
        None => &default,
        Some(sampler) => at(&data.root.samplers, sampler.value(), "samplers", place)?,
    };
    let wrap = |mode: Checked<WrappingMode>| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Invalid => Err(Fault::new(place(), "a sampler of an unknown wrapping mode", "one of glTF 2.0")),
    };
    Ok(Texture {
        image: texture.source.value(),
        wrap: [wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?],
        is_nearest: sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest)),
    })
}

fn image(data: &Data, image: &Image, index: usize) -> Result<ImageSource, Fault> {
    let place = format!("images[{index}]");
    let name = image.name.clone().filter(|name| !name.is_empty());
    let (name, content) = match (&image.uri, image.buffer_view) {
        (Some(uri), _) => match follow(data.path, uri, &place)? {
            Target::Bytes(bytes) => (name, ImageContent::Bytes(bytes)),
            Target::File(file) => {
                let file_name = file.file_name().map(|name| name.to_string_lossy().into_owned());
                (name.or(file_name), ImageContent::File(file))
            }
        },
        (None, Some(view)) => {
            let (bytes, _) = data.view(view, &place)?;
            data.spend(bytes.len() as u64, &place)?;
            (name, ImageContent::Bytes(bytes.to_vec()))
        }
        (None, None) => return Err(Fault::new(place, "neither uri nor bufferView", "one of them")),
    };
    Ok(ImageSource { name: name.unwrap_or(place), content })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transformed(json: &str, [s, t]: [f32; 2]) -> [f32; 2] {
        rows(&serde_json::from_str(json).unwrap()).map(|[a, b, c]| ((a * s + b * t + c) * 1e6).round() / 1e6)
    }

    #[test]
    fn transforms_scale_then_turn_then_move() {
        assert_eq!(transformed("{}", [0.25, 0.5]), [0.25, 0.5]);
        assert_eq!(transformed(r#"{"scale":[2,3],"offset":[10,20]}"#, [1.0, 1.0]), [12.0, 23.0]);
        // A quarter turn takes s to up, which is -t.
        let quarter = r#"{"rotation":1.5707964,"scale":[2,1],"offset":[0,5]}"#;
        assert_eq!(transformed(quarter, [1.0, 0.0]), [0.0, 3.0]);
        assert_eq!(transformed(quarter, [0.0, 1.0]), [1.0, 5.0]);
    }
}
