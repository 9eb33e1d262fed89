//! What a renderer hands over: colour, layers and metadata of one frame.

use std::collections::HashSet;

use crate::{Cryptomatte, Error, Layer, Metadata, Result};

/// The colour's channels, in the order of [`Film::color`].
pub(crate) const COLOR_CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

/// EXR's limit on the name of a channel or an attribute, in bytes.
const MAX_NAME: usize = 255;

/// One finished frame. All pixel arrays hold `width * height` pixels, row by row, the top row first, left to right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Where those pixels lie in the frame, if they are not all of it.
    pub window: Option<Window>,
    /// Scene-linear RGB with the primaries of Rec. 709, premultiplied by the coverage in the fourth component.
    pub color: Vec<[f32; 4]>,
    /// What is stored besides the colour. PNG files leave it out.
    pub layers: Vec<Layer>,
    /// Mattes for what is seen in each pixel. PNG files leave them out.
    pub cryptomattes: Vec<Cryptomatte>,
    /// What the header tells about the frame. PNG files leave it out.
    pub metadata: Metadata,
}

/// A film's place in its frame: EXR's data window is `width * height` pixels from (`x`, `y`) on, its display window the
/// frame, whose upper left pixel is (0, 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Column of the film's first pixel; negative where the film begins left of the frame.
    pub x: i32,
    /// Row of the film's first pixel.
    pub y: i32,
    /// Pixels in a row of the frame.
    pub full_width: u32,
    /// Rows of the frame.
    pub full_height: u32,
}

impl Film {
    /// Width times height.
    pub fn pixel_count(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The window, or that of a film that is all of its frame.
    pub fn window(&self) -> Window {
        self.window.unwrap_or(Window { x: 0, y: 0, full_width: self.width, full_height: self.height })
    }

    /// Whether the film can be written; every writer asks first.
    ///
    /// # Errors
    /// The film has no pixels; its window is none or beyond EXR's coordinates; the colour, a layer or a Cryptomatte has
    /// the wrong length; a Cryptomatte has ranks that mean nothing; a name is unfit or taken.
    pub fn check(&self) -> Result<()> {
        let (width, height) = (self.width, self.height);
        if width == 0 || height == 0 {
            return Err(Error::EmptyFilm { width, height });
        }
        self.check_window()?;
        let pixel_count = self.pixel_count();
        if self.color.len() as u64 != pixel_count {
            return Err(Error::ColorLength { expected: pixel_count, found: self.color.len() });
        }
        let mut taken: HashSet<String> = COLOR_CHANNELS.map(str::to_owned).into();
        for layer in &self.layers {
            let (channel_count, found) = (layer.channel_count(), layer.samples.len());
            let expected = pixel_count * channel_count as u64;
            if found as u64 != expected {
                return Err(Error::LayerLength { layer: layer.name.clone(), expected, found, channel_count });
            }
            take_names(&layer.name, layer.channel_names(), &mut taken)?;
        }
        let mut names = HashSet::new();
        for matte in &self.cryptomattes {
            matte.check(pixel_count)?;
            take_names(&matte.name, matte.channel_names(), &mut taken)?;
            if !names.insert(&matte.name) {
                return Err(Error::DuplicateCryptomatte { name: matte.name.clone() });
            }
        }
        match self.metadata.extra.keys().find(|name| !is_name(&format!("planish/{name}"))) {
            Some(name) => Err(Error::AttributeName { name: name.clone() }),
            None => Ok(()),
        }
    }

    /// EXR counts pixels in `int`, and its readers compute with half of that range.
    fn check_window(&self) -> Result<()> {
        const LIMIT: i64 = i32::MAX as i64 / 2;
        let window = self.window();
        let ends = [(window.x, self.width), (window.y, self.height)];
        let is_far = ends.iter().any(|&(start, size)| {
            i64::from(start) < -LIMIT || i64::from(start) > LIMIT || i64::from(start) + i64::from(size) > LIMIT
        });
        let full = [window.full_width, window.full_height];
        if is_far || full.iter().any(|&size| size == 0 || i64::from(size) > LIMIT) {
            return Err(Error::Window { window, width: self.width, height: self.height });
        }
        Ok(())
    }
}

/// Channels of a layer, whose names must be fit for EXR and free.
fn take_names(layer: &str, channels: Vec<String>, taken: &mut HashSet<String>) -> Result<()> {
    for channel in channels {
        if !is_name(&channel) {
            return Err(Error::ChannelName { layer: layer.to_owned(), channel });
        }
        if taken.contains(&channel) {
            return Err(Error::DuplicateChannel { channel });
        }
        taken.insert(channel);
    }
    Ok(())
}

fn is_name(name: &str) -> bool {
    let is_printable = name.bytes().all(|byte| byte.is_ascii_graphic() || byte == b' ');
    (1..=MAX_NAME).contains(&name.len()) && is_printable
}
