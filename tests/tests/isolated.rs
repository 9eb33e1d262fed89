//! The setting of the DFAS paper: isolated extraordinary vertices, each with a depth of its own, in one frame. What is drawn is
//! known in closed form.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use planish_generate::sectors::disc;
use planish_tests::folder::temporary;
use planish_tests::ply::Dump;
use planish_tests::program::Planish;
use serde_json::{Value, json};

const REGULAR: u8 = 0;
const TRANSITION: u8 = 1;
const QUAD: u8 = 2;

/// A vertex with quads all around, whose density is 2^depth.
#[derive(Clone, Copy, Debug)]
struct Pole {
    valence: u32,
    depth: u32,
}

impl Pole {
    /// A sector has a face at the vertex and three around it.
    fn face_count(self) -> u32 {
        4 * self.valence
    }

    /// Patches of each level: three a sector, and at the last a patch-filling quad.
    fn patches_by_level(self) -> Vec<u32> {
        (0..=self.depth).map(|level| self.valence * if level == self.depth { 4 } else { 3 }).collect()
    }

    /// Triangles of each level and kind with whole factors, but those of transition patches: the count of these is that of
    /// their sub-patches' tessellation.
    fn triangles(self) -> BTreeMap<(u8, u8), u32> {
        let mut triangles = BTreeMap::new();
        for level in 0..=self.depth {
            let is_last = level == self.depth;
            let regular = self.valence * if is_last { 3 } else { 1 };
            triangles.insert((level as u8, REGULAR), regular * 2 * 4_u32.pow(self.depth - level));
            if is_last {
                triangles.insert((level as u8, QUAD), 2 * self.valence);
            }
        }
        triangles
    }
}

/// All valences of the paper's tables, at two depths each.
fn poles() -> Vec<Pole> {
    let valences = (3..=40).filter(|&valence| valence != 4);
    valences.flat_map(|valence| [0, 2].map(|shift| Pole { valence, depth: (valence + shift) % 5 })).collect()
}

/// Writes a scene of these poles, side by side.
fn write_scene(folder: &Path, poles: &[Pole]) -> PathBuf {
    let (mut meshes, mut instances) = (Vec::new(), Vec::new());
    for (index, &Pole { valence, depth }) in poles.iter().enumerate() {
        let cage = disc(valence);
        let mut text = cage.to_obj("An isolated vertex.");
        let vertex_count = text.lines().filter(|line| line.starts_with("v ")).count();
        let vertices: String = (0..vertex_count).map(|vertex| format!(" {vertex}")).collect();
        writeln!(text, "t density {vertex_count}/1/0{vertices} {}", 1 << depth).unwrap();
        let name = format!("{index}.obj");
        fs::write(folder.join(&name), text).unwrap();
        meshes.push(json!({"name": name, "file": name}));
        instances.push(json!({"mesh": name, "translate": [10 * index, 0, 0]}));
    }
    let path = folder.join("poles.json");
    fs::write(&path, json!({"meshes": meshes, "instances": instances}).to_string()).unwrap();
    path
}

/// Patches by level and kind.
type Counts = BTreeMap<(u8, u8), u32>;

/// The frame of `--stats -`, and for each pole its triangles by level and kind.
fn drawn(poles: &[Pole], flags: &str) -> (Value, Vec<Counts>) {
    let folder = temporary();
    let (path, out) = (write_scene(folder.path(), poles), folder.path().join("dump.ply"));
    let outcome = Planish::dump(&path, &out).flags(flags).flags("--tess 1 --spacing equal --stats -").run();
    let frame = outcome.silent_success().unwrap().json().unwrap()["frames"][0].clone();
    let owners: Vec<usize> =
        poles.iter().enumerate().flat_map(|(index, pole)| vec![index; pole.face_count() as usize]).collect();
    let mut triangles = vec![BTreeMap::new(); poles.len()];
    for vertex in Dump::read(&out).unwrap().vertices().step_by(3) {
        *triangles[owners[vertex.face as usize]].entry((vertex.level, vertex.kind)).or_default() += 1;
    }
    (frame, triangles)
}

fn sum_by_level(poles: &[Pole]) -> Vec<u32> {
    let mut sums = vec![0; 1 + poles.iter().map(|pole| pole.depth).max().unwrap() as usize];
    for pole in poles {
        pole.patches_by_level().iter().zip(&mut sums).for_each(|(count, sum)| *sum += count);
    }
    sums
}

#[test]
fn isolated_vertices_each_have_their_depth_with_one_regular_and_two_transition_patches_a_sector_and_level() {
    let poles = poles();
    let (frame, triangles) = drawn(&poles, "");
    assert_eq!(frame["patches_by_level"], json!(sum_by_level(&poles)));
    let sectors = |of: fn(Pole) -> u32| poles.iter().map(|&pole| pole.valence * of(pole)).sum::<u32>();
    let expected = json!({
        "regular": sectors(|pole| pole.depth + 3), "transition": sectors(|pole| 2 * pole.depth),
        "quad": sectors(|_| 1), "gregory_quad": 0, "gregory_triangle": 0, "table": 0, "truncated": 0
    });
    assert_eq!(frame["patches"], expected);
    for (pole, mut found) in poles.iter().zip(triangles) {
        let transitions = (0..=pole.depth as u8).filter(|&level| found.remove(&(level, TRANSITION)).is_some());
        assert!(transitions.eq(0..pole.depth as u8), "{pole:?}");
        assert_eq!(found, pole.triangles(), "{pole:?}");
    }
}

#[test]
fn static_refinement_takes_all_to_the_depth_of_the_deepest() {
    let poles: Vec<Pole> = [3, 5, 6, 7, 40].map(|valence| Pole { valence, depth: valence % 4 }).to_vec();
    let deepest: Vec<Pole> = poles.iter().map(|&pole| Pole { depth: 3, ..pole }).collect();
    let (frame, _) = drawn(&poles, "--method fas");
    assert_eq!(frame["patches_by_level"], json!(sum_by_level(&deepest)));
}
