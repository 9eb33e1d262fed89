//! Images and how they are sampled (UsdUVTexture).
use std::collections::HashMap;
use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;

use openusd::ar::split_package_relative_path_outer;

use super::guard;
use crate::{ImageContent, ImageSource, Texture, Wrap};

/// Largest image in a package, bytes.
const MAX_IMAGE: u64 = 1 << 28;

/// Images and textures, each once.
#[derive(Default)]
pub struct Textures {
    pub textures: Vec<Texture>,
    pub images: Vec<ImageSource>,
    known: HashMap<String, usize>,
}

impl Textures {
    /// The image of an asset. It is not opened, unless it is in a package.
    pub fn image(&mut self, asset: &str) -> usize {
        if let Some(&image) = self.known.get(asset) {
            return image;
        }
        let packed = asset.ends_with(']').then(|| packed(asset)).flatten();
        let content = packed.map_or_else(|| ImageContent::File(PathBuf::from(asset)), ImageContent::Bytes);
        let name = crate::error::shown(asset.rsplit(['/', '[']).next().unwrap_or(asset).trim_end_matches(']'));
        self.images.push(ImageSource { name, content });
        self.known.insert(asset.to_owned(), self.images.len() - 1);
        self.images.len() - 1
    }

    pub fn texture(&mut self, asset: &str, wrap: [Wrap; 2]) -> usize {
        let texture = Texture { image: self.image(asset), wrap, is_nearest: false };
        self.textures.iter().position(|known| *known == texture).unwrap_or_else(|| {
            self.textures.push(texture);
            self.textures.len() - 1
        })
    }
}

/// The bytes of an image in a package; none if it cannot be read.
fn packed(asset: &str) -> Option<Vec<u8>> {
    let (package, entry) = split_package_relative_path_outer(asset)?;
    let package = File::open(package).ok()?;
    let size = package.metadata().ok()?.len();
    guard::entry(BufReader::new(package), size, &entry, MAX_IMAGE).ok()
}
