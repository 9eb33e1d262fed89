//! Writes the meshes of `scenes/` and larger ones of any size.
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, Result, ensure};
use clap::{Parser, Subcommand};
use planish_generate::cage::Cage;
use planish_generate::creased::add_creases;
use planish_generate::random_cage::{Features, Recipe};
use planish_generate::{large, scenes, sheets, solids};

/// Most faces of a generated mesh.
const MAX_FACES: u32 = 50_000_000;

/// Makes meshes; the same arguments give the same bytes.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// (Re)writes all meshes of scenes/
    Scenes {
        /// Folder to write into
        folder: PathBuf,
    },
    /// Hills on a square grid
    Terrain {
        /// About how many quads
        #[arg(long, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FACES)))]
        faces: u32,
        /// OBJ file to write
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
                write(&folder.join(scene.file_name()), &scene.text())?;
            }
            Ok(())
        }
        Command::Terrain { faces, out } => write_cage(&out, "Hills on a grid.", &large::terrain(faces)),
        Command::Blob { faces, irregular, creased, out } => {
            ensure!((0.0..=1.0).contains(&irregular), "--irregular: found {irregular}, expected 0 to 1");
            ensure!((0.0..=1.0).contains(&creased), "--creased: found {creased}, expected 0 to 1");
            let mut cage = large::blob(faces, irregular);
            add_creases(&mut cage, creased);
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

fn write_cage(path: &Path, comment: &str, cage: &Cage) -> Result<()> {
    write(path, &cage.to_obj(comment))
}

/// Writes a file beside its place and renames it, so that none is left half written.
fn write(path: &Path, text: &str) -> Result<()> {
    let beside = path.with_extension("obj.part");
    std::fs::write(&beside, text).with_context(|| format!("{}: cannot be written", beside.display()))?;
    std::fs::rename(&beside, path).with_context(|| format!("{}: cannot be written", path.display()))
}
