//! Writes the files of `scenes/`, larger meshes of any size, and scenes of them.
use std::path::{Component, Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, Result, ensure};
use clap::{Parser, Subcommand};
use planish_generate::cage::Cage;
use planish_generate::creased::add_creases;
use planish_generate::random_cage::{Features, Recipe};
use planish_generate::{crowd, distances, flight, large, scenes, sheets, solids, terrain};
use planish_scene::{LoadOptions, MAX_FRAMES, MAX_INSTANCES};

/// Most faces of a generated mesh.
const MAX_FACES: u32 = 50_000_000;

/// Makes meshes and scenes; the same arguments give the same bytes.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// (Re)writes all files of scenes/
    Scenes {
        /// Folder to write into
        folder: PathBuf,
    },
    /// Hills, and beside them a scene file with a camera path `flight` through their valleys
    Terrain {
        /// About how many quads
        #[arg(long, default_value_t = 17_136, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FACES)))]
        faces: u32,
        /// About which share of the faces has an extraordinary vertex
        #[arg(long, default_value_t = 0.1312)]
        irregular: f64,
        /// OBJ file to write; the scene file has the same name with `.json`
        #[arg(short, long)]
        out: PathBuf,
    },
    /// A scene of many small figures, and beside it their mesh
    Crowd {
        /// How many figures
        #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_INSTANCES)))]
        count: u32,
        /// JSON file to write; the mesh file has the same name with `.obj`
        #[arg(short, long)]
        out: PathBuf,
    },
    /// A scene of one model with a camera path `distances`, from where it fills the frame to 20 diagonals away
    Orbit {
        /// The model, an OBJ file
        model: PathBuf,
        /// Frames of the path
        #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FRAMES)))]
        frames: u32,
        /// JSON file to write
        #[arg(short, long)]
        out: PathBuf,
    },
    /// A closed lumpy blob with extraordinary vertices all over
    Blob {
        /// About how many quads
        #[arg(long, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FACES)))]
        faces: u32,
        /// About which share of the faces has an extraordinary vertex
        #[arg(long, default_value_t = 0.15)]
        irregular: f64,
        /// About which share of the edges is creased
        #[arg(long, default_value_t = 0.0)]
        creased: f64,
        /// Split every quad in two triangles, along its shorter diagonal
        #[arg(long)]
        triangles: bool,
        /// OBJ file to write
        #[arg(short, long)]
        out: PathBuf,
    },
    /// A torus, all regular
    Torus {
        /// Quads around the axis
        #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u32).range(3..=7000))]
        u: u32,
        /// Quads around the tube
        #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(3..=7000))]
        v: u32,
        /// OBJ file to write
        #[arg(short, long)]
        out: PathBuf,
    },
    /// A random cage with random tags, for tests
    Random {
        /// Where the random numbers begin
        #[arg(long)]
        seed: u64,
        /// What it may have, separated by commas: `all`, or any of those that `--help` lists
        #[arg(long, default_value = "all", value_parser = features, long_help = features_help())]
        features: Features,
        /// Operations tried on the base shape
        #[arg(long, default_value_t = 12)]
        operations: u32,
        /// OBJ file to write
        #[arg(short, long)]
        out: PathBuf,
    },
    /// A waved grid
    Grid {
        /// Columns of quads
        #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=7000))]
        columns: u32,
        /// Rows of quads
        #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=7000))]
        rows: u32,
        /// OBJ file to write
        #[arg(short, long)]
        out: PathBuf,
    },
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("planish-generate: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    match Arguments::parse().command {
        Command::Scenes { folder } => {
            for scene in scenes::all() {
                write(&folder.join(scene.file_name()), scene.text())?;
            }
            let schemes = folder.join(scenes::SCHEMES_FOLDER);
            std::fs::create_dir_all(&schemes).with_context(|| format!("{}: cannot be made", schemes.display()))?;
            for scene in scenes::of_schemes() {
                write(&schemes.join(scene.file_name()), scene.text())?;
            }
            for (name, scene) in scenes::placed() {
                write(&folder.join(format!("{name}.json")), scene.to_json())?;
            }
            for (name, scene) in scenes::gltf() {
                write(&folder.join(format!("{name}.gltf")), scene.to_gltf())?;
                write(&folder.join(format!("{name}.glb")), scene.to_glb())?;
            }
            Ok(())
        }
        Command::Terrain { faces, irregular, out } => {
            ensure!((0.0..=1.0).contains(&irregular), "--irregular: found {irregular}, expected 0 to 1");
            let (mesh, scene) = pair(&out, "obj")?;
            write_cage(&mesh, "Hills.", &terrain::terrain(faces, irregular))?;
            write(&scene, flight::scene(faces, file_name(&mesh)?).to_json())
        }
        Command::Crowd { count, out } => {
            let (mesh, scene) = pair(&out, "json")?;
            write_cage(&mesh, "A small figure.", &crowd::figure())?;
            write(&scene, crowd::scene(count, file_name(&mesh)?).to_json())
        }
        Command::Orbit { model, frames, out } => {
            let scene = planish_scene::load(&model, &LoadOptions::default())?;
            let file = seen_from(&out, &model)?;
            let text = distances::scene(&scene, &file, frames).with_context(|| model.display().to_string())?;
            write(&out, text.to_json())
        }
        Command::Blob { faces, irregular, creased, triangles, out } => {
            ensure!((0.0..=1.0).contains(&irregular), "--irregular: found {irregular}, expected 0 to 1");
            ensure!((0.0..=1.0).contains(&creased), "--creased: found {creased}, expected 0 to 1");
            let mut cage = large::blob(faces, irregular);
            add_creases(&mut cage, creased);
            if triangles {
                cage.split_quads();
            }
            write_cage(&out, "A closed blob with extraordinary vertices all over.", &cage)
        }
        Command::Torus { u, v, out } => write_cage(&out, "A torus of regular quads.", &solids::torus(u, v)),
        Command::Random { seed, features, operations, out } => {
            let recipe = Recipe { seed, features, operation_count: operations };
            write_cage(&out, &format!("A random cage: {recipe:?}."), &recipe.cage())
        }
        Command::Grid { columns, rows, out } => {
            write_cage(&out, "A waved grid of quads.", &sheets::waved_grid(columns, rows))
        }
    }
}

/// Features by their names, or by their bits.
fn features(text: &str) -> Result<Features> {
    if let Ok(bits) = text.parse() {
        return Ok(Features(bits));
    }
    let mut features = Features::PLAIN;
    for name in text.split(',').filter(|name| !name.is_empty()) {
        let known = Features::NAMES.iter().find(|(known, _)| *known == name).map(|&(_, feature)| feature);
        let feature = if name == "all" { Some(Features::ALL) } else { known };
        features = features.with(feature.with_context(|| format!("unknown feature {name}"))?);
    }
    Ok(features)
}

fn features_help() -> String {
    let names: Vec<&str> = Features::NAMES.iter().map(|&(name, _)| name).collect();
    format!("What it may have, separated by commas: all, {}; or the sum of their bits in this order", names.join(", "))
}

/// A mesh file and a scene file side by side, of which `out`, with the extension `expected`, is one.
fn pair(out: &Path, expected: &str) -> Result<(PathBuf, PathBuf)> {
    let fits = out.extension().is_some_and(|extension| extension == expected);
    ensure!(fits, "--out: found {}, expected a name that ends in .{expected}", out.display());
    Ok((out.with_extension("obj"), out.with_extension("json")))
}

fn file_name(path: &Path) -> Result<&str> {
    let name = path.file_name().and_then(|name| name.to_str());
    name.with_context(|| format!("{}: expected a name in Unicode", path.display()))
}

/// The path to a file as seen from the folder of another.
fn seen_from(other: &Path, file: &Path) -> Result<String> {
    let absolute = |path: &Path| path.canonicalize().with_context(|| format!("{}: cannot be found", path.display()));
    let folder = other.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (folder, file) = (absolute(folder)?, absolute(file)?);
    let shared = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    let path: PathBuf = up.chain(file.components().skip(shared)).collect();
    path.to_str().map(str::to_owned).with_context(|| format!("{}: expected a path in Unicode", path.display()))
}

fn write_cage(path: &Path, comment: &str, cage: &Cage) -> Result<()> {
    write(path, cage.to_obj(comment))
}

/// Writes a file beside its place and renames it, so that none is left half written.
fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<()> {
    let beside = path.with_added_extension("part");
    std::fs::write(&beside, content).with_context(|| format!("{}: cannot be written", beside.display()))?;
    std::fs::rename(&beside, path).with_context(|| format!("{}: cannot be written", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_as_seen_from_the_scenes_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(path("a/b")).unwrap();
        std::fs::create_dir(path("c")).unwrap();
        std::fs::write(path("a/m.obj"), "").unwrap();
        for (scene, expected) in [("a/s.json", "m.obj"), ("a/b/s.json", "../m.obj"), ("c/s.json", "../a/m.obj")] {
            assert_eq!(seen_from(&path(scene), &path("a/m.obj")).unwrap(), expected);
        }
        assert!(seen_from(&path("no/s.json"), &path("a/m.obj")).is_err());
    }

    #[test]
    fn a_mesh_and_its_scene_stand_side_by_side() {
        let pair_of = |out: &str, expected| pair(Path::new(out), expected).map_err(|error| error.to_string());
        let expected = Ok((PathBuf::from("x/a.b.obj"), PathBuf::from("x/a.b.json")));
        assert_eq!(pair_of("x/a.b.obj", "obj"), expected);
        assert_eq!(pair_of("x/a.b.json", "json"), expected);
        let message = "--out: found x/a.obj, expected a name that ends in .json".to_owned();
        assert_eq!(pair_of("x/a.obj", "json"), Err(message));
    }
}
