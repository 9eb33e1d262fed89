//! Tables that were made before: what names one, and how it is written down.
//!
//! A table follows from its key alone, so what is read back is what would be made, bit for bit.
//!
//! ```text
//! key:      | format u32 | sources u64 | scheme u8 | triangles u8 | creasing u8 | extent u8 | level u32 | word u32.. |
//! grid:     | controls: count u32, places in the walk u32.. | weights f32.. | tangents 2 f32.. |
//! vertex:   | weights of position and tangents 3 f32.. |
//! ```
//!
//! All little-endian. The word ([`Walk`]) has faces, vertices, sharpness and what lies across edges: boundaries, too. Positions,
//! holes, and how often the cage was split first change which configurations there are, not their tables.

use crate::basis::grid::{Extent, GridTable};
use crate::basis::walk::Walk;
use crate::mesh::{Creasing, TriangleSubdivision};
use crate::scheme::Scheme;

/// Contents by their keys, kept somewhere. Both sides may fail in silence: what is not found is made.
pub trait BasisCache {
    /// What was stored by this key.
    fn load(&self, key: &[u8]) -> Option<Vec<u8>>;

    /// Keeps a content.
    fn store(&self, key: &[u8], content: &[u8]);
}

/// Keeps nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoCache;

impl BasisCache for NoCache {
    fn load(&self, _key: &[u8]) -> Option<Vec<u8>> {
        None
    }

    fn store(&self, _key: &[u8], _content: &[u8]) {}
}

/// Where the tables of configurations came from: those of faces, edges and vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BasisCounts {
    /// From the cache.
    pub read: u64,
    /// From the rules.
    pub built: u64,
}

/// Layout of keys and contents.
const FORMAT: u32 = 1;

/// All that tables are made by: with another line in any of these no table of before is found.
const SOURCES: &[&[u8]] = &[
    include_bytes!("build.rs"),
    include_bytes!("cache.rs"),
    include_bytes!("grid.rs"),
    include_bytes!("limit.rs"),
    include_bytes!("poly.rs"),
    include_bytes!("source.rs"),
    include_bytes!("step.rs"),
    include_bytes!("walk.rs"),
    include_bytes!("../mesh.rs"),
    include_bytes!("../rules.rs"),
    include_bytes!("../scheme/butterfly.rs"),
    include_bytes!("../scheme/catmull_clark.rs"),
    include_bytes!("../scheme/loop_scheme.rs"),
    include_bytes!("../scheme/loop_stam.rs"),
    include_bytes!("../scheme/mod.rs"),
    // Sines and cosines are the platform's.
    std::env::consts::OS.as_bytes(),
    std::env::consts::ARCH.as_bytes(),
];

/// Names [`SOURCES`].
const FINGERPRINT: u64 = fingerprint(SOURCES);

/// FNV-1a of 64 bits, of all bytes and of where each part ends.
const fn fingerprint(parts: &[&[u8]]) -> u64 {
    const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    let (mut hash, mut part) = (BASIS, 0);
    while part < parts.len() {
        let mut at = 0;
        while at < parts[part].len() {
            hash = (hash ^ parts[part][at] as u64).wrapping_mul(PRIME);
            at += 1;
        }
        hash = (hash ^ at as u64).wrapping_mul(PRIME);
        part += 1;
    }
    hash
}

/// What a configuration's table is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A grid of 2^`level` segments a side.
    Grid { extent: Extent, level: u32 },
    /// The limit of a vertex.
    Vertex,
}

/// All but the word that a table follows from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rulebook {
    pub scheme: Scheme,
    pub triangles: TriangleSubdivision,
    pub creasing: Creasing,
}

impl Rulebook {
    /// The key of a configuration.
    pub fn key(&self, kind: Kind, word: &[u32]) -> Vec<u8> {
        let (extent, level) = match kind {
            Kind::Grid { extent: Extent::Face, level } => (0, level),
            Kind::Grid { extent: Extent::Edge, level } => (1, level),
            Kind::Vertex => (2, 0),
        };
        let mut key = FORMAT.to_le_bytes().to_vec();
        key.extend(FINGERPRINT.to_le_bytes());
        key.extend([self.scheme as u8, self.triangles as u8, self.creasing as u8, extent]);
        key.extend(level.to_le_bytes());
        key.extend(word.iter().flat_map(|word| word.to_le_bytes()));
        key
    }
}

/// A grid as bytes.
pub(crate) fn grid_content(table: &GridTable) -> Vec<u8> {
    let mut content = (table.controls.len() as u32).to_le_bytes().to_vec();
    content.extend(table.controls.iter().flat_map(|control| control.to_le_bytes()));
    content.extend(table.positions.iter().flat_map(|weight| weight.to_le_bytes()));
    content.extend(table.tangents.as_flattened().iter().flat_map(|weight| weight.to_le_bytes()));
    content
}

/// A grid of so many rows over a walk; nothing where the bytes are none.
pub(crate) fn read_grid(content: &[u8], walk: &Walk, row_count: usize) -> Option<GridTable> {
    let (count, rest) = content.split_first_chunk()?;
    let count = u32::from_le_bytes(*count) as usize;
    let weight_count = row_count.checked_mul(count).filter(|_| count <= walk.vertices.len())?;
    if rest.len() != WORD * (count + 3 * weight_count) {
        return None;
    }
    let (controls, weights) = rest.split_at(WORD * count);
    let (positions, tangents) = weights.split_at(WORD * weight_count);
    let controls: Vec<u32> = words(controls).map(u32::from_le_bytes).collect();
    // The first vertex is the origin of all rows.
    let is_walked = controls.first() == Some(&0) && (*controls.last()? as usize) < walk.vertices.len();
    let tangents: Vec<f32> = words(tangents).map(f32::from_le_bytes).collect();
    (is_walked && controls.is_sorted_by(|a, b| a < b)).then(|| GridTable {
        controls,
        positions: words(positions).map(f32::from_le_bytes).collect(),
        tangents: tangents.as_chunks().0.to_vec(),
    })
}

/// The limit of a vertex as bytes.
pub(crate) fn vertex_content(weights: &[[f32; 3]]) -> Vec<u8> {
    weights.as_flattened().iter().flat_map(|weight| weight.to_le_bytes()).collect()
}

/// Weights of all points of a walk; nothing where the bytes are none.
pub(crate) fn read_vertex(content: &[u8], walk: &Walk) -> Option<Vec<[f32; 3]>> {
    let weights: Vec<f32> = words(content).map(f32::from_le_bytes).collect();
    (content.len() == 3 * WORD * walk.vertices.len()).then(|| weights.as_chunks().0.to_vec())
}

/// Bytes of an index or a weight.
const WORD: usize = 4;

fn words(bytes: &[u8]) -> impl Iterator<Item = [u8; WORD]> {
    bytes.as_chunks().0.iter().copied()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    use super::*;

    #[test]
    fn every_part_of_a_key_changes_it() {
        let plain = Rulebook {
            scheme: Scheme::CatmullClark,
            triangles: TriangleSubdivision::CatmullClark,
            creasing: Creasing::Uniform,
        };
        let grid = |extent, level| Kind::Grid { extent, level };
        let word = [4, 0, 0, 1, 2];
        let mut keys = BTreeSet::new();
        let mut count = 0;
        let mut add = |key: Vec<u8>| {
            keys.insert(key);
            count += 1;
        };
        for scheme in Scheme::ALL {
            add(Rulebook { scheme, ..plain }.key(grid(Extent::Face, 5), &word));
        }
        add(Rulebook { triangles: TriangleSubdivision::Smooth, ..plain }.key(grid(Extent::Face, 5), &word));
        add(Rulebook { creasing: Creasing::Chaikin, ..plain }.key(grid(Extent::Face, 5), &word));
        for kind in [grid(Extent::Edge, 5), grid(Extent::Face, 4), grid(Extent::Face, 6), Kind::Vertex] {
            add(plain.key(kind, &word));
        }
        for i in 0..word.len() {
            for bit in 0..u32::BITS {
                let mut other = word;
                other[i] ^= 1 << bit;
                add(plain.key(grid(Extent::Face, 5), &other));
            }
            add(plain.key(grid(Extent::Face, 5), &word[..i]));
        }
        assert_eq!(keys.len(), count);
    }

    #[test]
    fn a_fingerprint_knows_every_byte_and_where_parts_end() {
        let sources: [&[&[u8]]; 5] = [&[b"ab", b"c"], &[b"a", b"bc"], &[b"ab", b"d"], &[b"abc"], &[b"c", b"ab"]];
        let prints: BTreeSet<u64> = sources.into_iter().map(fingerprint).collect();
        assert_eq!(prints.len(), sources.len());
    }

    #[test]
    fn all_rules_are_among_the_sources() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        // How large a set is, and the list of modules: no table follows from them.
        let others = ["basis/fixed.rs", "basis/mod.rs"].map(|name| root.join(name));
        for folder in ["basis", "scheme"] {
            for entry in fs::read_dir(root.join(folder)).unwrap() {
                let path = entry.unwrap().path();
                let content = fs::read(&path).unwrap();
                assert!(others.contains(&path) || SOURCES.contains(&content.as_slice()), "{}", path.display());
            }
        }
    }
}
