//! The command line: every flag, once.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::builder::RangedU64ValueParser;
use clap::{Args, Parser, Subcommand};
use glam::Vec3;
use planish_film::{Compression, ToneMap};
use planish_gpu::DeviceOptions;
use planish_render::{Density, SurfaceMethod};
use planish_scene::LoadOptions;
use planish_subdiv::scheme::Scheme;

use crate::aov::AovList;
use crate::frames::FrameRange;
use crate::names::{
    CreasePatchesName, DisplacementKindName, DisplacementLayoutName, EndCapName, FilterName, GregoryNormalsName,
    GregoryPointsName, LodName, MethodName, MetricName, SchemeName, SpacingName, TableNormalsName, TableWeightsName,
    ViewName, name_of,
};
use crate::values::{self, FrameRate, MAX_LEVEL};

/// Level that irregularities are isolated to at most.
const DEFAULT_MAX_LEVEL: u32 = 10;
/// Most samples a pixel.
const MAX_SAMPLES: u64 = 1 << 16;
/// Most samples of a dump.
const MAX_COMPARED_SAMPLES: u64 = 100_000_000;
/// Most timed frames.
const MAX_REPEAT: u64 = 1_000_000;

/// Renders subdivision surfaces with Vulkan tessellation shaders.
#[derive(Debug, Parser)]
#[command(name = "planish", version, max_term_width = 100, arg_required_else_help = false)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// What is told on the way.
    #[command(flatten)]
    pub console: ConsoleArguments,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render frames to EXR or PNG, by extension
    Render(RenderArguments),
    /// Write the tessellated limit surface, as the tessellation stages produce it, to PLY
    Dump(DumpArguments),
    /// Measure how far one dump lies from another
    Compare(CompareArguments),
    /// Describe a scene: mesh, features, patches by level and type, memory; needs no device
    Info(InfoArguments),
    /// Time the surface methods side by side
    Bench(BenchArguments),
    /// List the Vulkan devices, and whether each can run planish (and if not, why)
    Devices,
}

/// Flags of every command.
#[derive(Debug, Args)]
pub struct ConsoleArguments {
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Explain what is done, on standard error
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

/// `planish render`
#[derive(Debug, Args)]
pub struct RenderArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// File to write, .exr or .png; several may be given
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub outputs: Vec<PathBuf>,
    #[command(flatten)]
    pub surface: SurfaceArguments,
    #[command(flatten)]
    pub displacement: DisplacementArguments,
    #[command(flatten)]
    pub view: ViewArguments,
    /// Samples a pixel, each a whole frame
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = RangedU64ValueParser::<u32>::new().range(1..=MAX_SAMPLES))]
    pub samples: u32,
    #[command(flatten)]
    pub sampling: SamplingArguments,
    /// Extra layers of EXR files: z, n, p, uv, st, face, patch, level, tess, object, motion (to the next frame, in pixels), color (of vertices), each of one sample at the pixel's centre; crypto_object, crypto_material, of all samples
    #[arg(long, value_name = "LIST", default_value = "", hide_default_value = true)]
    pub aov: AovList,
    /// What the beauty image shows
    #[arg(long = "view", value_name = "VIEW", value_enum, default_value_t = ViewName::Shaded)]
    pub shown: ViewName,
    #[command(flatten)]
    pub light: LightArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    /// Draw a part of the image alone: left and top, and size, in pixels; the data window of EXR files, all of a PNG
    #[arg(long, value_name = "X,Y,WxH", value_parser = values::crop)]
    pub crop: Option<[u32; 4]>,
    /// Leave frames alone whose files are there and whole
    #[arg(long)]
    pub skip_existing: bool,
    /// Go on with the next frame where one fails; the exit status tells
    #[arg(long)]
    pub continue_on_error: bool,
    #[command(flatten)]
    pub frames: FrameArguments,
    #[command(flatten)]
    pub device: DeviceArguments,
}

/// `planish dump`
#[derive(Debug, Args)]
pub struct DumpArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// File to write, .ply
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: SurfaceArguments,
    #[command(flatten)]
    pub displacement: DisplacementArguments,
    #[command(flatten)]
    pub view: ViewArguments,
    #[command(flatten)]
    pub frames: FrameArguments,
    #[command(flatten)]
    pub device: DeviceArguments,
}

/// `planish compare`
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Dump to judge, .ply
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// Dump that it is compared with, .ply; taken as triangles, so better denser than A
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// Points on each surface, spread evenly by area, whose nearest points on the other are looked for, besides those of all vertices for the greatest distance; 0 for none
    #[arg(long, value_name = "N", default_value_t = 200_000, value_parser = RangedU64ValueParser::<u32>::new().range(0..=MAX_COMPARED_SAMPLES))]
    pub samples: u32,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Draw A coloured by distance, blue for none to red, .png or .exr
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Draw A coloured by the angle between normals, .png or .exr
    #[arg(long, value_name = "OUT")]
    pub normal_view: Option<PathBuf>,
    /// What the pictures show
    #[arg(long, value_enum, default_value_t = MetricName::Parametric)]
    pub metric: MetricName,
    /// Distance that is drawn red [default: the greatest]
    #[arg(long, value_name = "MAX", value_parser = values::positive, allow_negative_numbers = true)]
    pub scale: Option<f64>,
    /// Angle that is drawn red [default: the greatest]
    #[arg(long, value_name = "DEG", value_parser = values::positive, allow_negative_numbers = true)]
    pub normal_scale: Option<f64>,
    /// Size of the pictures in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = values::size)]
    pub size: [u32; 2],
}

/// `planish info`
#[derive(Debug, Args)]
pub struct InfoArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub surface: SurfaceArguments,
    #[command(flatten)]
    pub view: ViewArguments,
    /// Tell how large the tables of method table are for any cage, of valences 3 to 18, too
    #[arg(long)]
    pub fixed_set: bool,
    /// Refine so many times and print the median times
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = repeat_parser())]
    pub repeat: u32,
}

/// `planish bench`
#[derive(Debug, Args)]
pub struct BenchArguments {
    /// Scenes to time, each in its default view
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,
    /// Drop degenerate faces with a warning instead of refusing the file
    #[arg(long)]
    pub repair: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Levels at which fas, at tess factor 2^level, is compared with uniform refinement to that level
    #[arg(long, value_name = "A-B", default_value = "0-5", value_parser = values::levels)]
    pub levels: RangeInclusive<u32>,
    /// Time fas alone at these tess factors instead
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = values::tess_factor, conflicts_with_all = ["levels", "cpu"])]
    pub tess: Vec<f32>,
    /// Time fas and dfas side by side along this camera path instead
    #[arg(long, value_name = "NAME", conflicts_with_all = ["levels", "cpu", "tess"])]
    pub path: Option<String>,
    /// Every so many frames of the path
    #[arg(long, value_name = "N", default_value_t = 1, requires = "path", value_parser = repeat_parser())]
    pub step: u32,
    /// Write a chart of the path's frames to an .svg file
    #[arg(long, value_name = "FILE", requires = "path")]
    pub chart: Option<PathBuf>,
    /// Triangle edges of about so many pixels along a path
    #[arg(long, value_name = "P", default_value_t = 4.0, value_parser = values::edge_pixels, allow_negative_numbers = true)]
    pub edge_pixels: f32,
    /// Draw the scene's cameras with fas and dfas side by side instead
    #[arg(long, conflicts_with_all = ["levels", "cpu", "tess", "path"])]
    pub cameras: bool,
    /// Time fas at these tess factors with each kind of crease patches
    #[arg(long, requires = "tess")]
    pub creases: bool,
    /// Time fas and dfas at these tess factors with and without watertight seams
    #[arg(long, requires = "tess", conflicts_with = "creases")]
    pub seams: bool,
    /// Time fas, dfas, both implementations of gregory and, on cages that they have patches for, acc and pm in turns instead, with nothing culled, at tess factors 6, 10, 17 and 25 or those given
    #[arg(long, conflicts_with_all = ["levels", "cpu", "path", "cameras", "creases", "seams"])]
    pub gregory: bool,
    /// Time method table with flat, phong and pn, fas and dfas in turns instead, with nothing culled, at tess factors 4, 16 and 32 or those given
    #[arg(long, conflicts_with_all = ["levels", "path", "cameras", "creases", "seams", "gregory"])]
    pub tables: bool,
    /// Time the building of tables for these levels instead, on one thread of the CPU; needs no device. With --tables the building of those, and reading them from a cache
    #[arg(long)]
    pub cpu: bool,
    /// No irregularity is isolated deeper
    #[arg(long, value_name = "L", default_value_t = DEFAULT_MAX_LEVEL, value_parser = level_parser())]
    pub max_level: u32,
    /// Spacing of tessellated points
    #[arg(long, value_enum, default_value_t = SpacingName::Equal)]
    pub spacing: SpacingName,
    /// Trade bitwise equal seams for speed
    #[arg(long)]
    pub no_watertight: bool,
    /// Draw what culling would leave out
    #[arg(long)]
    pub no_cull: bool,
    /// Size of the image in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = values::size)]
    pub size: [u32; 2],
    /// Timed frames, after one that is not timed
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = repeat_parser())]
    pub repeat: u32,
    /// Folder with osd_bench, OpenSubdiv's own pipeline, to time beside fas
    #[arg(long, value_name = "DIR", env = "PLANISH_ORACLE_DIR")]
    pub peer: Option<PathBuf>,
    #[command(flatten)]
    pub displacement: DisplacementArguments,
    #[command(flatten)]
    pub device: DeviceArguments,
}

/// Which file, and how it is read.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// Scene file: .obj, .json, .gltf, .glb, .usda, .usdc, .usd
    #[arg(value_name = "SCENE")]
    pub path: PathBuf,
    /// Drop degenerate faces (a vertex twice, fewer than three) with a warning, instead of refusing the file
    #[arg(long)]
    pub repair: bool,
    /// Animation of a glTF file that has several [default: its first]
    #[arg(long, value_name = "NAME")]
    pub clip: Option<String>,
    /// Make quads of pairs of triangles of glTF files that have nothing else, where they are good ones
    #[arg(long)]
    pub quads: bool,
}

impl SceneArguments {
    /// A file without options.
    pub fn plain(path: PathBuf, repair: bool) -> Self {
        Self { path, repair, clip: None, quads: false }
    }

    /// As the readers want it.
    pub fn load_options(&self) -> LoadOptions {
        LoadOptions { repair: self.repair, clip: self.clip.clone(), quads: self.quads }
    }
}

/// How the surface is evaluated.
#[derive(Debug, Args)]
pub struct SurfaceArguments {
    /// Surface method
    #[arg(long, value_enum, default_value_t = MethodName::Dfas)]
    method: MethodName,
    /// Subdivision scheme, instead of the file's
    #[arg(long, value_enum)]
    scheme: Option<SchemeName>,
    /// The same tess factor, from 1 to 16000, on every base edge
    #[arg(long, value_name = "T", value_parser = values::tess_factor, conflicts_with = "edge_pixels", allow_negative_numbers = true)]
    pub tess: Option<f32>,
    /// Triangle edges of about so many pixels [default: 4]
    #[arg(long, value_name = "P", value_parser = values::edge_pixels, allow_negative_numbers = true)]
    pub edge_pixels: Option<f32>,
    /// No irregularity is isolated deeper [default: 10]
    #[arg(long = "max-level", value_name = "L", value_parser = level_parser())]
    pub asked_max_level: Option<u32>,
    /// Spacing of tessellated points
    #[arg(long, value_enum, default_value_t = SpacingName::FractionalOdd)]
    pub spacing: SpacingName,
    /// What has a density of its own
    #[arg(long, value_enum, default_value_t = LodName::Vertex)]
    pub lod: LodName,
    /// Creases that are patches of their own, instead of being refined to the last level
    #[arg(long, value_enum, default_value_t = CreasePatchesName::Infinite)]
    pub crease_patches: CreasePatchesName,
    /// How control points of Gregory patches are made
    #[arg(long, value_enum, default_value_t = GregoryPointsName::TwoStage)]
    pub gregory: GregoryPointsName,
    /// What irregular faces are drawn as where --max-level ends refinement, by methods fas and dfas; gregory, acc and pm do not refine
    #[arg(long, value_enum, default_value_t = EndCapName::Quad)]
    pub end_cap: EndCapName,
    /// Normals of Gregory patches: of their Bezier form, exact along edges, or of the rational patch
    #[arg(long, value_enum, default_value_t = GregoryNormalsName::Approximate)]
    pub gregory_normals: GregoryNormalsName,
    /// Where normals of method table come from
    #[arg(long, value_enum, default_value_t = TableNormalsName::Tangent)]
    pub table_normals: TableNormalsName,
    /// How weights of method table are stored
    #[arg(long, value_enum, default_value_t = TableWeightsName::Float)]
    pub table_weights: TableWeightsName,
    /// Folder with tables of method table that were made before, or none [default: planish/tables in $XDG_CACHE_HOME, else in ~/.cache]
    #[arg(long, value_name = "DIR|none", env = "PLANISH_TABLE_CACHE")]
    pub table_cache: Option<PathBuf>,
    /// Trade bitwise equal seams for speed
    #[arg(long)]
    pub no_watertight: bool,
}

impl SurfaceArguments {
    /// The method.
    pub fn method(&self) -> SurfaceMethod {
        match self.method {
            MethodName::Fas => SurfaceMethod::Fas,
            MethodName::Dfas => SurfaceMethod::Dfas,
            MethodName::Gregory => SurfaceMethod::Gregory,
            MethodName::Acc => SurfaceMethod::Acc,
            MethodName::Pm => SurfaceMethod::Pm,
            MethodName::Uniform => SurfaceMethod::Uniform,
            MethodName::Table => SurfaceMethod::Table,
            MethodName::Flat => SurfaceMethod::Flat,
            MethodName::Phong => SurfaceMethod::Phong,
            MethodName::Pn => SurfaceMethod::Pn,
        }
    }

    /// The scheme; refused where it does not exist yet, or the method does not know it.
    pub fn scheme(&self) -> Result<Scheme> {
        let scheme = match self.scheme {
            None | Some(SchemeName::CatmullClark) => return Ok(Scheme::CatmullClark),
            Some(SchemeName::Loop) => Scheme::Loop,
            Some(SchemeName::LoopStam) => Scheme::LoopStam,
            Some(SchemeName::Butterfly) => Scheme::Butterfly,
            Some(other @ SchemeName::Bilinear) => bail!(
                "scheme {} is not available yet (available: catmull-clark, loop, loop-stam, butterfly)",
                name_of(other)
            ),
        };
        if self.method() != SurfaceMethod::Table {
            bail!(
                "scheme {} is evaluated by table: found --method {}, expected --method table",
                scheme.name(),
                name_of(self.method)
            );
        }
        Ok(scheme)
    }

    /// How finely to tessellate.
    pub fn density(&self) -> Density {
        match (self.tess, self.edge_pixels) {
            (Some(factor), _) => Density::Tess(factor),
            (None, Some(pixels)) => Density::EdgePixels(pixels),
            (None, None) => Density::default(),
        }
    }

    /// Level below which nothing is refined.
    pub fn max_level(&self) -> u32 {
        self.asked_max_level.unwrap_or(DEFAULT_MAX_LEVEL)
    }
}

/// A displacement map for all meshes instead of the scene's, or what is different with the scene's.
#[derive(Debug, Default, Args)]
pub struct DisplacementArguments {
    /// Displacement map, .exr, .png or .tiff, instead of the scene's; `<UDIM>` in its name stands for the tile
    #[arg(long = "displacement", value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// A texel displaces by S * (value - M) [default: 1]
    #[arg(long = "displacement-scale", value_name = "S", value_parser = values::finite, allow_hyphen_values = true)]
    pub scale: Option<f64>,
    /// Value that does not displace [default: 0]
    #[arg(long = "displacement-midpoint", value_name = "M", value_parser = values::finite, allow_hyphen_values = true)]
    pub midpoint: Option<f64>,
    /// One number along the normal, or an offset x, y, z in the mesh's space [default: scalar]
    #[arg(long = "displacement-kind", value_enum)]
    pub kind: Option<DisplacementKindName>,
    /// Over texture coordinates, or an atlas of one tile a Ptex face [default: uv]
    #[arg(long = "displacement-layout", value_enum)]
    pub layout: Option<DisplacementLayoutName>,
}

/// From where the scene is seen.
#[derive(Debug, Args)]
pub struct ViewArguments {
    /// Camera of the scene [default: its first, else a default view]
    #[arg(long, value_name = "NAME", conflicts_with = "eye")]
    pub camera: Option<String>,
    /// Where the camera stands
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true, requires = "target")]
    pub eye: Option<Vec3>,
    /// What the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true, requires = "eye")]
    pub target: Option<Vec3>,
    /// Vertical field of view in degrees [default: the camera's; 45 with --eye]
    #[arg(long, value_name = "DEG", value_parser = values::field_of_view, allow_negative_numbers = true)]
    pub fov: Option<f32>,
    /// Size of the image in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = values::size)]
    pub size: [u32; 2],
}

/// Which frames, and what is told of them.
#[derive(Debug, Args)]
pub struct FrameArguments {
    /// Frames A, A-B, A-BxS, A:B or A:BxS; of several, OUT holds #### where the number goes
    #[arg(long, value_name = "RANGE", allow_hyphen_values = true)]
    pub frames: Option<FrameRange>,
    /// Frames a second [default: the scene's, else 24]
    #[arg(long, value_name = "F", value_parser = values::frame_rate)]
    pub fps: Option<FrameRate>,
    /// Draw what culling would leave out; dump never culls
    #[arg(long)]
    pub no_cull: bool,
    /// Write counts and times as JSON to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Time so many frames, after one that is not timed
    #[arg(long, value_name = "N", value_parser = repeat_parser())]
    pub repeat: Option<u32>,
}

/// What lights a scene.
#[derive(Debug, Args)]
pub struct LightArguments {
    /// Image of all around, in latitude and longitude, .exr or .hdr, instead of the scene's
    #[arg(long, value_name = "FILE")]
    pub environment: Option<PathBuf>,
    /// Turns the environment about the y axis, in degrees, counter-clockwise seen from above
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = values::finite, allow_hyphen_values = true)]
    pub environment_rotation: f64,
    /// Makes the environment brighter, in stops
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, value_parser = values::stops, allow_hyphen_values = true)]
    pub environment_exposure: f32,
    /// Texels of the side of a light's shadow map
    #[arg(long, value_name = "N", default_value_t = 2048, value_parser = RangedU64ValueParser::<u32>::new().range(16..=8192))]
    pub shadow_map_size: u32,
    /// The environment is seen behind the scene, which it covers: the alpha is 1 there
    #[arg(long)]
    pub show_environment: bool,
}

/// How image files are made.
#[derive(Debug, Args)]
pub struct OutputArguments {
    /// Compression of EXR files: zip, zips, piz, rle, none, dwaa or dwaa:LEVEL, which are for the colour alone
    #[arg(long, value_name = "NAME", default_value = "zip")]
    pub compression: Compression,
    /// A part of EXR files for every layer, instead of layers in one part
    #[arg(long)]
    pub multipart: bool,
    /// What becomes of light in PNG files: clip, neutral (Khronos PBR Neutral) or aces
    #[arg(long, value_name = "NAME", default_value = "clip")]
    pub tone_map: ToneMap,
    /// Brighter PNG files, in stops
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, value_parser = values::stops, allow_hyphen_values = true)]
    pub exposure: f32,
}

/// What the samples of a pixel are drawn from.
#[derive(Debug, Args)]
pub struct SamplingArguments {
    /// Filter that the samples of a pixel follow; a single sample is at its centre
    #[arg(long, value_enum, default_value_t = FilterName::BlackmanHarris)]
    pub filter: FilterName,
    /// Width of the filter in pixels [default: box 1, triangle 2, gaussian 2.5, blackman-harris 2]
    #[arg(long, value_name = "W", value_parser = values::filter_width)]
    pub filter_width: Option<f64>,
    /// When the shutter opens and closes, in frames from the frame's own time, over which samples are spread; one number closes it so long after [default: the camera's, else none]
    #[arg(long, value_name = "OPEN,CLOSE", value_parser = values::shutter, allow_hyphen_values = true)]
    pub shutter: Option<[f64; 2]>,
    /// Everything is in focus, whatever the camera's lens
    #[arg(long)]
    pub no_depth_of_field: bool,
}

/// Which device.
#[derive(Debug, Args)]
pub struct DeviceArguments {
    /// Part of the device's name, or its index [default: discrete, then integrated, then software]
    #[arg(long, value_name = "NAME|INDEX")]
    device: Option<String>,
    /// Run under Khronos validation with synchronization checks; any message is an error
    #[arg(long)]
    validation: bool,
}

impl DeviceArguments {
    /// As the backend wants it.
    pub fn options(&self) -> DeviceOptions {
        DeviceOptions { validation: self.validation, selector: self.device.clone(), memory_budget: None }
    }
}

fn repeat_parser() -> RangedU64ValueParser<u32> {
    RangedU64ValueParser::new().range(1..=MAX_REPEAT)
}

fn level_parser() -> RangedU64ValueParser<u32> {
    RangedU64ValueParser::new().range(0..=u64::from(MAX_LEVEL))
}

/// What is wrong with a command line, in one line, without the usage that follows in clap's own words.
pub fn usage_error(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let paragraphs = text.split("\n\n").filter(|told| !told.starts_with("Usage:") && !told.starts_with("For more"));
    let one_line =
        |told: &str| told.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    let told = paragraphs.map(one_line).filter(|told| !told.is_empty()).collect::<Vec<_>>().join("; ");
    format!("{} (planish --help explains)", told.strip_prefix("error: ").unwrap_or(&told))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;
    use planish_render::{Spacing, View};

    fn parse(line: &str) -> Result<Arguments, String> {
        Arguments::try_parse_from(line.split(' ')).map_err(|error| usage_error(&error))
    }

    fn render(line: &str) -> RenderArguments {
        match parse(format!("planish render a.obj -o a.exr {line}").trim_end()).unwrap().command {
            Command::Render(arguments) => arguments,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn definitions_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn the_defaults_are_the_interface_s() {
        let arguments = render("");
        assert_eq!(arguments.surface.method(), SurfaceMethod::Dfas);
        assert_eq!(arguments.surface.density(), Density::EdgePixels(4.0));
        assert_eq!((arguments.surface.max_level(), arguments.view.size, arguments.samples), (10, [1280, 720], 1));
        assert_eq!(Spacing::from(arguments.surface.spacing), Spacing::FractionalOdd);
        assert_eq!(View::from(arguments.shown), View::Shaded);
    }

    #[test]
    fn vectors_may_begin_with_a_minus() {
        let arguments = render("--eye -1,2,3 --target -4,-5,-6");
        assert_eq!(arguments.view.eye, Some(Vec3::new(-1.0, 2.0, 3.0)));
        assert_eq!(arguments.view.target, Some(Vec3::new(-4.0, -5.0, -6.0)));
    }

    #[test]
    fn stats_may_go_to_standard_output() {
        assert_eq!(render("--stats -").frames.stats, Some(PathBuf::from("-")));
    }

    #[test]
    fn schemes_are_refused_where_they_are_not_known() {
        let scheme = |line: &str| render(line).surface.scheme();
        let message = |line: &str| scheme(line).unwrap_err().to_string();
        assert_eq!(
            message("--scheme bilinear"),
            "scheme bilinear is not available yet (available: catmull-clark, loop, loop-stam, butterfly)"
        );
        assert_eq!(
            message("--scheme loop"),
            "scheme loop is evaluated by table: found --method dfas, expected --method table"
        );
        assert_eq!(scheme("--scheme loop --method table").unwrap(), Scheme::Loop);
        assert_eq!(scheme("--scheme catmull-clark").unwrap(), Scheme::CatmullClark);
    }

    #[test]
    fn wrong_usage_is_told_in_one_line() {
        for line in [
            "planish",
            "planish paint",
            "planish render a.obj",
            "planish render -o a.exr",
            "planish render a.obj -o a.exr --tess 2 --edge-pixels 3",
            "planish render a.obj -o a.exr --eye 1,2,3",
            "planish render a.obj -o a.exr --tess 0.5",
            "planish render a.obj -o a.exr --tess -3",
            "planish render a.obj -o a.exr --samples 0",
            "planish render a.obj -o a.exr --size 0x5",
            "planish render a.obj -o a.exr --max-level 16",
            "planish render a.obj -o a.exr --aov z,paint",
            "planish render a.obj -o a.exr --colour red",
            "planish render a.obj -o a.exr -q -v",
            "planish bench a.obj --cpu --tess 4",
        ] {
            let message = parse(line).err().unwrap_or_else(|| panic!("{line} was accepted"));
            assert!(!message.contains('\n') && !message.contains("Usage"), "{line}: {message}");
        }
    }
}
