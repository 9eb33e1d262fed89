//! Cryptomatte: ids and coverages, from which a compositor makes an antialiased matte of any object by its name.
//!
//! After "Cryptomatte specification", version 1.2.0 (Psyop; files of version 1.1 are the same in all that is written
//! here), on the idea of Friedman and Jones, "Fully automatic ID mattes with support for motion blur and transparency",
//! SIGGRAPH 2015 posters.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use crate::{Error, Layer, Result, murmur};

/// How many ids a pixel holds unless something else is asked for: three layers of two.
pub const DEFAULT_RANK_COUNT: usize = 6;

/// An id and its coverage, twice a layer.
const RANKS_PER_LAYER: usize = 2;

/// Layers are numbered with two digits.
const MAX_RANK_COUNT: usize = 100 * RANKS_PER_LAYER;

/// Characters of the key that metadata stands under.
const KEY_LENGTH: usize = 7;

/// What covers each pixel of a film, and how much of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cryptomatte {
    /// `CryptoObject`, `CryptoMaterial`: channels are `CryptoObject00.R` and so on.
    pub name: String,
    /// What can be seen, by name. Those that cover nothing may be among them; the manifest lists all, so that it is the
    /// same in all frames.
    pub names: Vec<String>,
    /// Entries a pixel of `ranks`; an odd number is written with one more, which is empty.
    pub rank_count: usize,
    /// For each pixel `rank_count` indices into `names`, with the share of the pixel that each covers, from 0 to 1; in
    /// any order. [`Cryptomatte::NONE`] is the index of an entry that is not used.
    pub ranks: Vec<(u32, f32)>,
}

impl Cryptomatte {
    /// The index of nothing: the background, or an entry that is not used.
    pub const NONE: u32 = u32::MAX;

    /// A Cryptomatte of [`DEFAULT_RANK_COUNT`] ranks in which nothing is covered.
    pub fn new(name: &str, names: Vec<String>, pixel_count: usize) -> Self {
        let ranks = vec![(Self::NONE, 0.0); DEFAULT_RANK_COUNT * pixel_count];
        Self { name: name.to_owned(), names, rank_count: DEFAULT_RANK_COUNT, ranks }
    }

    /// Adds what a sample covers of a pixel: to the entry of its name, or to one that is not used. Where there is none,
    /// the entry with the least coverage gives way to one with more. [`Cryptomatte::NONE`] adds nothing.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub fn add(&mut self, pixel: usize, index: u32, coverage: f32) {
        let ranks = &mut self.ranks[pixel * self.rank_count..][..self.rank_count];
        if index == Self::NONE {
            return;
        }
        if let Some((_, sum)) = ranks.iter_mut().find(|(known, _)| *known == index) {
            *sum += coverage;
            return;
        }
        // One that is not used has a coverage of 0; of several that are least the first gives way.
        let least = ranks.iter_mut().min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some(least) = least.filter(|least| least.1 < coverage) {
            *least = (index, coverage);
        }
    }

    /// Whether ranks and names fit each other and a film of so many pixels.
    pub(crate) fn check(&self, pixel_count: u64) -> Result<()> {
        let name = || self.name.clone();
        if !(1..=MAX_RANK_COUNT).contains(&self.rank_count) {
            return Err(Error::RankCount { name: name(), found: self.rank_count, most: MAX_RANK_COUNT });
        }
        let (expected, found) = (pixel_count * self.rank_count as u64, self.ranks.len());
        if found as u64 != expected {
            return Err(Error::RankLength { name: name(), expected, found, rank_count: self.rank_count });
        }
        let is_known = |index: u32| index == Self::NONE || (index as usize) < self.names.len();
        if let Some(&(index, _)) = self.ranks.iter().find(|&&(index, _)| !is_known(index)) {
            return Err(Error::RankIndex { name: name(), index, name_count: self.names.len() });
        }
        match self.ranks.iter().find(|&&(_, coverage)| !(coverage.is_finite() && coverage >= 0.0)) {
            Some(&(_, coverage)) => Err(Error::RankCoverage { name: name(), coverage }),
            None => Ok(()),
        }
    }

    fn layer_count(&self) -> usize {
        self.rank_count.div_ceil(RANKS_PER_LAYER)
    }

    fn layer_name(&self, layer: usize) -> String {
        format!("{}{layer:02}", self.name)
    }

    pub(crate) fn channel_names(&self) -> Vec<String> {
        let names = |layer| ["R", "G", "B", "A"].map(|component| format!("{}.{component}", self.layer_name(layer)));
        (0..self.layer_count()).flat_map(names).collect()
    }

    /// The layers as they are written: id and coverage of ranks 0 and 1 in the first's R G and B A, and so on. The most
    /// coverage comes first, then the smallest id; what is empty is 0.
    pub(crate) fn layers(&self) -> Vec<Layer> {
        let ids: Vec<u32> = self.names.iter().map(|name| id_bits(name)).collect();
        let mut samples = vec![Vec::with_capacity(4 * self.ranks.len() / self.rank_count); self.layer_count()];
        let mut sorted = Vec::new();
        for pixel in self.ranks.chunks_exact(self.rank_count) {
            sort_pixel(pixel, &ids, &mut sorted);
            for (layer, samples) in samples.iter_mut().enumerate() {
                for rank in RANKS_PER_LAYER * layer..RANKS_PER_LAYER * (layer + 1) {
                    let (id, coverage) = sorted.get(rank).copied().unwrap_or_default();
                    samples.extend([f32::from_bits(id), coverage]);
                }
            }
        }
        let layer = |(layer, samples)| Layer::float(&self.layer_name(layer), &["R", "G", "B", "A"], samples);
        samples.into_iter().enumerate().map(layer).collect()
    }

    /// Attributes of the header by their names.
    pub(crate) fn attributes(&self) -> [(String, String); 4] {
        let hash = format!("{:08x}", murmur::hash(self.name.as_bytes()));
        let key = |field| format!("cryptomatte/{}/{field}", &hash[..KEY_LENGTH]);
        [
            (key("name"), self.name.clone()),
            (key("hash"), "MurmurHash3_32".to_owned()),
            (key("conversion"), "uint32_to_float32".to_owned()),
            (key("manifest"), self.manifest()),
        ]
    }

    /// A JSON object of names, sorted, with the bits of their ids as eight hexadecimal digits.
    fn manifest(&self) -> String {
        let entries: BTreeMap<&str, String> =
            self.names.iter().map(|name| (name.as_str(), format!("{:08x}", id_bits(name)))).collect();
        serde_json::to_string(&entries).expect("names are strings")
    }
}

/// The entries of a pixel that cover something, those of one id as one, in the order in which they are written.
fn sort_pixel(pixel: &[(u32, f32)], ids: &[u32], sorted: &mut Vec<(u32, f32)>) {
    sorted.clear();
    for &(index, coverage) in pixel {
        let Some(&id) = ids.get(index as usize).filter(|_| coverage > 0.0) else { continue };
        match sorted.iter_mut().find(|(known, _)| *known == id) {
            Some((_, sum)) => *sum += coverage,
            None => sorted.push((id, coverage)),
        }
    }
    let by_coverage = |a: &(u32, f32), b: &(u32, f32)| b.1.partial_cmp(&a.1).unwrap_or(Ordering::Equal);
    sorted.sort_by(|a, b| by_coverage(a, b).then(a.0.cmp(&b.0)));
}

/// The bits of the float that stands for a name: its hash, but for exponents that mean denormals, infinities or not a
/// number, of which the lowest bit is turned ("Float conversion" in the specification).
pub(crate) fn id_bits(name: &str) -> u32 {
    guard_exponent(murmur::hash(name.as_bytes()))
}

fn guard_exponent(hash: u32) -> u32 {
    const MANTISSA_BITS: u32 = 23;
    match hash >> MANTISSA_BITS & 0xff {
        0 | 0xff => hash ^ 1 << MANTISSA_BITS,
        _ => hash,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Samples;

    #[test]
    fn ids_are_those_of_the_specification() {
        // Its example manifest: {"bunny":"13851a76","default":"42c9679f"}.
        assert_eq!(id_bits("bunny"), 0x1385_1a76);
        assert_eq!(id_bits("default"), 0x42c9_679f);
    }

    #[test]
    fn no_hash_becomes_a_denormal_or_a_not_a_number() {
        for low in [0, 1, 0x7f_ffff] {
            for sign in [0, 1 << 31] {
                for exponent in 0..=255_u32 {
                    let hash = sign | exponent << 23 | low;
                    let guarded = guard_exponent(hash);
                    assert!(f32::from_bits(guarded).is_normal(), "{hash:08x}");
                    assert_eq!(guarded == hash, !matches!(exponent, 0 | 255));
                }
            }
        }
    }

    fn matte() -> Cryptomatte {
        Cryptomatte {
            name: "CryptoObject".to_owned(),
            names: ["bunny", "default", "a \"b\" ü"].map(str::to_owned).into(),
            rank_count: 3,
            ranks: vec![
                (0, 0.25),
                (Cryptomatte::NONE, 0.5),
                (1, 0.75),
                (1, 0.5),
                (2, 0.0),
                (0, 0.5),
                (2, 0.125),
                (2, 0.25),
                (0, 0.25),
            ],
        }
    }

    #[test]
    fn ranks_are_sorted_by_coverage_then_id_and_entries_of_one_id_are_one() {
        let [bunny, default, quoted] = ["bunny", "default", "a \"b\" ü"].map(|name| f32::from_bits(id_bits(name)));
        let layers = matte().layers();
        let first = vec![default, 0.75, bunny, 0.25, bunny, 0.5, default, 0.5, quoted, 0.375, bunny, 0.25];
        assert_eq!(layers[0].samples, Samples::Float(first));
        assert_eq!(layers[1].samples, Samples::Float(vec![0.0; 12]));
        assert_eq!([&layers[0].name, &layers[1].name], ["CryptoObject00", "CryptoObject01"]);
        assert_eq!(layers.iter().flat_map(Layer::channel_names).collect::<Vec<_>>(), matte().channel_names());
    }

    #[test]
    fn samples_add_up_and_the_least_gives_way() {
        let names = (0..9).map(|i| i.to_string()).collect();
        let mut matte = Cryptomatte::new("CryptoObject", names, 2);
        for (index, coverage) in [(3, 0.25), (Cryptomatte::NONE, 0.25), (3, 0.25), (0, 0.125)] {
            matte.add(1, index, coverage);
        }
        assert_eq!(matte.ranks[..6], [(Cryptomatte::NONE, 0.0); 6]);
        assert_eq!(matte.ranks[6..8], [(3, 0.5), (0, 0.125)]);
        for index in [1, 2, 4, 5] {
            matte.add(1, index, 0.0625);
        }
        matte.add(1, 6, 0.0625);
        matte.add(1, 7, 0.25);
        let kept = [(3, 0.5), (0, 0.125), (7, 0.25), (2, 0.0625), (4, 0.0625), (5, 0.0625)];
        assert_eq!(matte.ranks[6..], kept);
        matte.check(2).unwrap();
    }

    #[test]
    fn the_manifest_is_sorted_json_under_seven_digits_of_the_name_s_hash() {
        let hash = format!("{:08x}", murmur::hash(b"CryptoObject"));
        let [name, _, _, manifest] = matte().attributes();
        assert_eq!(name, (format!("cryptomatte/{}/name", &hash[..7]), "CryptoObject".to_owned()));
        let quoted = format!("{:08x}", id_bits("a \"b\" ü"));
        let expected = format!(r#"{{"a \"b\" ü":"{quoted}","bunny":"13851a76","default":"42c9679f"}}"#);
        assert_eq!(manifest.1, expected);
    }
}
