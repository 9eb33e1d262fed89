//! Which channels go into which part.

use crate::{Cryptomatte, Error, ExrOptions, Film, Layer, Result, film::COLOR_CHANNELS};

use super::channels::{Channels, Source};
use super::options::Compression;

/// The part of the colour.
const COLOR_PART: &str = "rgba";

/// Suffixes of the names that DWA takes for light, and loses bits of where they are half or float; as OpenEXR's encoder
/// and this one's (`internal_dwa_classifier.h`, `sDefaultChannelRules`). It takes `N.Y` for a luminance.
const LOSSY_SUFFIXES: [&str; 6] = ["R", "G", "B", "Y", "RY", "BY"];

/// A part of a file: what a reader may read without the others.
pub(super) struct Part<'film> {
    /// The only part of a file needs no name.
    pub name: Option<String>,
    pub compression: Compression,
    pub channels: Channels<'film>,
    /// Those whose layers are in this part.
    pub cryptomattes: Vec<&'film Cryptomatte>,
}

/// A film in one part, or each of its layers in one. `mattes` are the film's with their layers.
pub(super) fn parts<'film>(
    film: &'film Film,
    mattes: &'film [(&'film Cryptomatte, Vec<Layer>)],
    options: &ExrOptions,
) -> Vec<Part<'film>> {
    let mut parts = vec![Part {
        name: options.multipart.then(|| COLOR_PART.to_owned()),
        compression: options.compression,
        channels: Channels::of_color(film),
        cryptomattes: Vec::new(),
    }];
    for layer in &film.layers {
        part_of(part_name(layer), film, options, &mut parts).channels.add(layer);
    }
    for (matte, layers) in mattes {
        let part = part_of(&matte.name, film, options, &mut parts);
        layers.iter().for_each(|layer| part.channels.add(layer));
        part.cryptomattes.push(matte);
    }
    parts
}

/// A layer's part is named as the layer, but depth as compositors call it.
fn part_name(layer: &Layer) -> &str {
    match layer.name.as_str() {
        "Z" => "depth",
        name => name,
    }
}

/// The part of this name, which is made if there is none: names of parts are unique.
fn part_of<'parts, 'film>(
    name: &str,
    film: &Film,
    options: &ExrOptions,
    parts: &'parts mut Vec<Part<'film>>,
) -> &'parts mut Part<'film> {
    let place =
        if options.multipart { parts.iter().position(|part| part.name.as_deref() == Some(name)) } else { Some(0) };
    let place = place.unwrap_or_else(|| {
        parts.push(Part {
            name: Some(name.to_owned()),
            compression: options.compression.lossless(),
            channels: Channels::new(film),
            cryptomattes: Vec::new(),
        });
        parts.len() - 1
    });
    &mut parts[place]
}

impl Part<'_> {
    /// Refuses what would lose bits of data: only the colour may.
    pub fn check_loss(&self) -> Result<()> {
        let Compression::Dwaa(_) = self.compression else { return Ok(()) };
        let is_lossy = |name: &str, source: &Source<'_>| {
            let suffix = name.rsplit('.').next().unwrap_or(name);
            !matches!(source, Source::Uint { .. }) && LOSSY_SUFFIXES.contains(&suffix)
        };
        let mut data = self.channels.iter().filter(|(name, _)| !COLOR_CHANNELS.contains(name));
        match data.find(|(name, source)| is_lossy(name, source)) {
            Some((channel, _)) => Err(Error::LossyLayer { channel: channel.to_owned() }),
            None => Ok(()),
        }
    }
}
