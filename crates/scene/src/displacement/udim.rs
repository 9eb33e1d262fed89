//! Names of tiles, and which of them UVs use.
//!
//! Tile (c, r) covers u from c to c + 1 and v from r to r + 1. `<UDIM>` stands for its number 1001 + c + 10 r, with c
//! below 10; `<UVTILE>` for `u{c + 1}_v{r + 1}`.
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::error::Fault;

/// Tiles in a row.
pub const COLUMNS: u32 = 10;
/// Most rows: the last tile is 9999, or with `<UVTILE>` `u10_v899`.
const ROWS: u32 = 900;
/// The first tile.
const FIRST: u32 = 1001;

/// What UVs need: for each set of tiles one of which they need, an example. A UV inside of a tile needs that tile; one on a
/// border either, one on a corner any of four.
pub type UsedTiles = BTreeMap<Vec<[i64; 2]>, [f32; 2]>;

/// The tiles that texture coordinates use, as (column, row), the tile that is sampled if it exists first.
pub fn used_tiles(values: impl IntoIterator<Item = [f32; 2]>) -> UsedTiles {
    let mut used = UsedTiles::new();
    for uv in values {
        used.entry(tiles_at(uv)).or_insert(uv);
    }
    used
}

/// The tiles that a UV may be sampled in, in this order.
fn tiles_at([u, v]: [f32; 2]) -> Vec<[i64; 2]> {
    let (columns, rows) = (intervals(u), intervals(v));
    rows.iter().flat_map(|&row| columns.iter().map(move |&column| [column, row])).collect()
}

/// The unit interval that a number is in, and the one before if it is on their border.
fn intervals(x: f32) -> Vec<i64> {
    let above = x.floor() as i64;
    if x.floor() == x { vec![above, above.saturating_sub(1)] } else { vec![above] }
}

/// A file name with a placeholder for its tile.
#[derive(Debug, PartialEq)]
pub struct Pattern {
    folder: PathBuf,
    before: String,
    after: String,
    naming: Naming,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Naming {
    Udim,
    UvTile,
}

impl Pattern {
    /// The pattern that a path's file name is, if it is one.
    pub fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let split = |mark: &str, naming| Some((name.split_once(mark)?, naming));
        let ((before, after), naming) = split("<UDIM>", Naming::Udim).or_else(|| split("<UVTILE>", Naming::UvTile))?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Some(Self { folder, before: before.to_owned(), after: after.to_owned(), naming })
    }

    /// The file of a tile.
    pub fn file(&self, column: u32, row: u32) -> PathBuf {
        let tile = match self.naming {
            Naming::Udim => (FIRST + column + COLUMNS * row).to_string(),
            Naming::UvTile => format!("u{}_v{}", column + 1, row + 1),
        };
        self.folder.join(format!("{}{tile}{}", self.before, self.after))
    }

    /// Column and row of every tile that has a file, by row, then column.
    pub fn existing(&self) -> Result<Vec<[u32; 2]>, Fault> {
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        let expected = || format!("files such as {}", self.file(0, 0).display());
        let unreadable =
            |error: std::io::Error| Fault::whole(format!("no folder that can be read ({error})"), expected());
        let mut tiles = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(unreadable)? {
            let name = entry.map_err(unreadable)?.file_name();
            tiles.extend(name.to_str().and_then(|name| self.tile_of(name)));
        }
        if tiles.is_empty() {
            return Err(Fault::whole("no file of any tile", expected()));
        }
        tiles.sort_unstable_by_key(|&[column, row]| (row, column));
        Ok(tiles)
    }

    /// Column and row of the tile that a file name stands for.
    fn tile_of(&self, name: &str) -> Option<[u32; 2]> {
        let tile = name.strip_prefix(self.before.as_str())?.strip_suffix(self.after.as_str())?;
        let number = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse::<u32>().ok())?;
        let [column, row] = match self.naming {
            Naming::Udim => {
                let index = number(tile)?.checked_sub(FIRST)?;
                [index % COLUMNS, index / COLUMNS]
            }
            Naming::UvTile => {
                let (column, row) = tile.strip_prefix('u')?.split_once("_v")?;
                [number(column)?.checked_sub(1)?, number(row)?.checked_sub(1)?]
            }
        };
        // The number is written as we write it: without leading zeros.
        let is_own = column < COLUMNS && row < ROWS && self.file(column, row).file_name()?.to_str()? == name;
        is_own.then_some([column, row])
    }

    /// Refuses UVs that are in no tile.
    pub fn check_used(&self, used: &UsedTiles, existing: &[[u32; 2]]) -> Result<(), Fault> {
        let exists = |&[column, row]: &[i64; 2]| {
            let tile = [u32::try_from(column), u32::try_from(row)];
            matches!(tile, [Ok(column), Ok(row)] if existing.contains(&[column, row]))
        };
        let Some((tiles, [u, v])) = used.iter().find(|(tiles, _)| !tiles.iter().any(exists)) else { return Ok(()) };
        let is_tile = |&&[column, row]: &&[i64; 2]| {
            (0..i64::from(COLUMNS)).contains(&column) && (0..i64::from(ROWS)).contains(&row)
        };
        let Some(&[column, row]) = tiles.iter().find(is_tile) else {
            let found = format!("UV ({u}, {v}), which is in no tile");
            return Err(Fault::whole(found, format!("u from 0 to {COLUMNS} and v from 0 to {ROWS}")));
        };
        let [column, row] = [column as u32, row as u32];
        let name = match self.naming {
            Naming::Udim => (FIRST + column + COLUMNS * row).to_string(),
            Naming::UvTile => format!("u{}_v{}", column + 1, row + 1),
        };
        let file = self.file(column, row);
        Err(Fault::whole(
            format!("no file for tile {name}, which UV ({u}, {v}) uses"),
            file.file_name().unwrap_or_default().to_string_lossy(),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_numbered_by_columns_of_ten() {
        let udim = Pattern::of(Path::new("maps/face.<UDIM>.exr")).unwrap();
        assert_eq!(udim.file(3, 2), Path::new("maps/face.1024.exr"));
        assert_eq!(udim.tile_of("face.1024.exr"), Some([3, 2]));
        for other in ["face.1000.exr", "face.1.exr", "face.01001.exr", "face.exr", "face.1024.png", "face.+1001.exr"] {
            assert_eq!(udim.tile_of(other), None, "{other}");
        }
        let tile = Pattern::of(Path::new("face_<UVTILE>.png")).unwrap();
        assert_eq!(tile.file(3, 2), Path::new("face_u4_v3.png"));
        assert_eq!(tile.tile_of("face_u4_v3.png"), Some([3, 2]));
        assert_eq!(tile.tile_of("face_u0_v3.png"), None);
        assert_eq!(tile.tile_of("face_u11_v3.png"), None);
        assert_eq!(Pattern::of(Path::new("<UDIM>/face.exr")), None);
    }

    #[test]
    fn a_uv_on_a_border_needs_either_tile() {
        let used = used_tiles([[0.5, 0.5], [0.7, 0.2], [1.0, 0.5], [1.0, 1.0], [1.5, 3.25]]);
        let tiles: Vec<_> = used.keys().cloned().collect();
        assert_eq!(tiles, [vec![[0, 0]], vec![[1, 0], [0, 0]], vec![[1, 1], [0, 1], [1, 0], [0, 0]], vec![[1, 3]],]);
        assert_eq!(used[&vec![[0, 0]]], [0.5, 0.5]);
    }

    #[test]
    fn missing_tiles_are_named_with_a_uv_that_needs_them() {
        let pattern = Pattern::of(Path::new("face.<UDIM>.exr")).unwrap();
        let check = |uv: [f32; 2]| pattern.check_used(&used_tiles([uv]), &[[0, 0]]);
        assert_eq!(check([1.0, 0.5]), Ok(()));
        assert_eq!(check([1.0, 1.0]), Ok(()));
        assert_eq!(
            check([1.5, 0.25]),
            Err(Fault::whole("no file for tile 1002, which UV (1.5, 0.25) uses", "face.1002.exr"))
        );
        for outside in [[-0.5, 0.5], [10.5, 0.5], [0.5, -1e30], [3e9, 0.1], [0.1, 900.5]] {
            assert!(check(outside).unwrap_err().found.ends_with("which is in no tile"), "{outside:?}");
        }
    }
}
