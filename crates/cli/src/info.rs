//! `planish info`: what a scene holds, and what refinement makes of it. Needs no Vulkan device.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use planish_render::spokes::{FACE_BYTES, RIVAL_SPOKE_BYTES, SPOKE_BYTES, STENCIL_BYTES};
use planish_render::{Preprocessed, SurfaceDesc, SurfaceMethod, TableWeights, preprocess_cached};
use planish_subdiv::edits::deepest_level;
use planish_subdiv::mesh::{
    BoundaryInterpolation, Creasing, FaceVaryingInterpolation, TriangleSubdivision, VertexInterpolation,
};
use planish_subdiv::selection::{PatchCounts, deepest_cut};
use planish_subdiv::tables::{GregoryKind, GregoryTable, IndexLists, TableSet, Tables, fixed_set};
use planish_subdiv::{ControlMesh, patch::PatchInfo};
use serde::Serialize;

use crate::args::InfoArguments;
use crate::bench::median;
use crate::cage::{Cage, MeshFacts};
use crate::console::{Console, print_output};
use crate::offline::{Plan, check_gregory};
use crate::scene_info::SceneInfo;
use crate::stats::method_name;
use crate::table_cache::TableCache;
use crate::text_table::{TextTable, bytes_text, milliseconds_text};

/// Runs the command.
pub fn run(arguments: &InfoArguments, console: &Console) -> Result<()> {
    let cage = Cage::load(&arguments.scene, console)?;
    let desc = surface_desc(arguments, &cage)?;
    let cache = TableCache::new(arguments.surface.table_cache.as_deref(), console);
    let preprocess = || preprocess_cached(&cage.meshes(), &desc, &cache);
    let mut made = preprocess().with_context(|| cage.path().display().to_string())?;
    let (mut topology, mut tables) = (vec![made.times.topology], vec![made.times.tables]);
    for _ in 1..arguments.repeat {
        let counts = made.basis_counts;
        made = preprocess()?;
        topology.push(made.times.topology);
        tables.push(made.times.tables);
        // What the first time found.
        made.basis_counts = counts;
    }
    (made.times.topology, made.times.tables) = (median(topology), median(tables));
    let info = Info::new(&cage, &desc, &made, arguments.fixed_set);
    print_output(&if arguments.json { serde_json::to_string_pretty(&info)? + "\n" } else { info.to_text() })
}

/// What to refine: to the level that the density asks for, or exactly to `--max-level` if that is given alone.
fn surface_desc(arguments: &InfoArguments, cage: &Cage) -> Result<SurfaceDesc> {
    let surface = &arguments.surface;
    match surface.asked_max_level {
        Some(level) if surface.tess.is_none() && surface.edge_pixels.is_none() => {
            let crease_patches = surface.crease_patches.into();
            let gregory_points = surface.gregory.into();
            let method = surface.method();
            let desc = SurfaceDesc {
                method,
                // One patch a face of the cage: nothing is refined.
                level: if method.is_one_patch_a_face() || method.is_grid() { 0 } else { level },
                crease_patches,
                end_cap: surface.end_cap.into(),
                displaced: false,
                gregory_points,
                scheme: surface.scheme()?,
                table_normals: surface.table_normals.into(),
                table_weights: surface.table_weights.into(),
            };
            check_gregory(cage, &desc)?;
            Ok(desc)
        }
        _ => {
            let rate = cage.frame_rate(None);
            Ok(Plan::unseen(cage, surface, &arguments.view, rate, cage.frame_range(None, rate))?.desc)
        }
    }
}

/// What is printed.
#[derive(Debug, Serialize)]
struct Info {
    version: &'static str,
    scene: String,
    scheme: &'static str,
    load_ms: f64,
    graph: SceneInfo,
    mesh: MeshFacts,
    features: Features,
    refinement: RefinementInfo,
}

/// Tags and options of a mesh.
#[derive(Debug, Serialize)]
struct Features {
    creases: usize,
    corners: usize,
    holes: usize,
    edits: usize,
    /// The finest level that an edit names a component of.
    deepest_edit_level: u32,
    uv: bool,
    /// How colours of vertices are interpolated, of the first mesh that has any.
    colors: Option<&'static str>,
    boundary: &'static str,
    creasing: &'static str,
    triangles: &'static str,
    face_varying: &'static str,
}

/// What refinement makes.
#[derive(Debug, Serialize)]
struct RefinementInfo {
    method: &'static str,
    /// Level of the irregular leaves.
    level: u32,
    preprocess_ms: BTreeMap<&'static str, f64>,
    memory_bytes: BTreeMap<&'static str, u64>,
    /// Tables of Gregory stencils, and patches that have one; if they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    gregory_stencils: Option<StencilInfo>,
    /// Basis function tables, of method table.
    #[serde(skip_serializing_if = "Option::is_none")]
    basis: Option<BasisInfo>,
    levels: Vec<LevelInfo>,
}

/// What basis function tables there are.
#[derive(Debug, Serialize)]
struct BasisInfo {
    /// Segments a side of a face.
    segments: u32,
    /// Distinct tables of faces, and the bytes of their weights of positions as floats.
    configurations: usize,
    weight_bytes: usize,
    /// Of faces, edges between them and tangents too, as they are stored.
    bytes: u64,
    /// How many configurations, of faces, edges and vertices, were read from the cache, and how many were built.
    read: u64,
    built: u64,
    /// The paper's set for any cage, if it was asked for: one extraordinary vertex of valence 3 to 18, inside and on boundaries.
    #[serde(skip_serializing_if = "Option::is_none")]
    fixed_set: Option<FixedSetInfo>,
}

/// The paper's fixed set of tables.
#[derive(Debug, Serialize)]
struct FixedSetInfo {
    configurations: usize,
    weight_bytes: usize,
}

/// What stencils of Gregory patches there are.
#[derive(Debug, Serialize)]
struct StencilInfo {
    connectivities: usize,
    faces: usize,
    /// Faces whose points are made in two stages all the same.
    faces_of_spokes: usize,
    bytes: u64,
}

/// What one level holds.
#[derive(Debug, Default, Serialize)]
struct LevelInfo {
    points: u64,
    regular: u32,
    transition: u32,
    quad: u32,
    /// Gregory patches of 20 points, and triangles of 15.
    gregory_quad: u32,
    gregory_triangle: u32,
    /// Faces that are evaluated by table.
    table: u32,
}

impl Info {
    fn new(cage: &Cage, desc: &SurfaceDesc, made: &Preprocessed, wants_fixed_set: bool) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            scene: cage.path().display().to_string(),
            scheme: desc.scheme.name(),
            load_ms: cage.load_ms,
            graph: SceneInfo::new(cage.scene()),
            mesh: cage.facts.clone(),
            features: Features::new(&cage.meshes(), cage.has_uv()),
            refinement: RefinementInfo::new(desc, made, wants_fixed_set),
        }
    }

    fn to_text(&self) -> String {
        let mut table = TextTable::default();
        let mut line = |name: &str, value: String| table.push([format!("{name:<22}{value}")]);
        let mesh = &self.mesh;
        line("scene", format!("{}, read in {} ms", self.scene, milliseconds_text(self.load_ms)));
        self.graph.describe(&mut line);
        line("vertices", mesh.vertices.to_string());
        line("faces", format!("{} ({})", mesh.faces, histogram(&mesh.faces_by_sides, "of", "sides")));
        line("ptex faces", mesh.ptex_faces.to_string());
        line("irregular faces", mesh.irregular_faces.to_string());
        line("extraordinary vertices", String::new());
        line("  inside", histogram(&mesh.extraordinary_by_valence, "of valence", ""));
        line("  on the boundary", histogram(&mesh.boundary_extraordinary_by_valence, "of valence", ""));
        line("boundary edges", format!("{}, interpolation: {}", mesh.boundary_edges, self.features.boundary));
        line("features", self.features.to_text());
        let sharp = mesh.sharp_features.iter().map(|(name, count)| format!("{count} {}", feature_text(name)));
        let sharp: Vec<String> = sharp.collect();
        line("sharp, not manifold", if sharp.is_empty() { "none".to_owned() } else { sharp.join(", ") });
        self.refinement.describe(&mut line);
        table.to_text() + "\n" + &self.refinement.levels_table().to_text()
    }
}

/// "semi-sharp edges" for `semi_sharp_edges`.
fn feature_text(name: &str) -> String {
    name.replace("semi_", "semi-").replace("non_", "non-").replace('_', " ")
}

/// "1452 of 4 sides, 3 of 5 sides".
fn histogram(counts: &BTreeMap<u32, u64>, of: &str, unit: &str) -> String {
    if counts.is_empty() {
        return "none".to_owned();
    }
    let parts: Vec<String> =
        counts.iter().map(|(key, count)| format!("{count} {of} {key} {unit}").trim_end().to_owned()).collect();
    parts.join(", ")
}

impl Features {
    /// Of all meshes; options are those of the first.
    fn new(meshes: &[&ControlMesh], uv: bool) -> Self {
        let options = meshes.first().map(|mesh| mesh.options).unwrap_or_default();
        let sum = |of: fn(&ControlMesh) -> usize| meshes.iter().map(|mesh| of(mesh)).sum();
        Self {
            creases: sum(|mesh| mesh.creases.len()),
            corners: sum(|mesh| mesh.corners.len()),
            holes: sum(|mesh| mesh.holes.len()),
            edits: sum(|mesh| mesh.edits.len()),
            deepest_edit_level: meshes.iter().map(|mesh| deepest_level(mesh)).max().unwrap_or(0),
            uv,
            colors: meshes.iter().find_map(|mesh| mesh.colors.as_ref()).map(|colors| match colors.interpolation {
                VertexInterpolation::Vertex => "vertex",
                VertexInterpolation::Varying => "varying",
            }),
            boundary: match options.boundary {
                BoundaryInterpolation::None => "none",
                BoundaryInterpolation::EdgeOnly => "edge only",
                BoundaryInterpolation::EdgeAndCorner => "edge and corner",
            },
            creasing: match options.creasing {
                Creasing::Uniform => "uniform",
                Creasing::Chaikin => "chaikin",
            },
            triangles: match options.triangles {
                TriangleSubdivision::CatmullClark => "catmull-clark",
                TriangleSubdivision::Smooth => "smooth",
            },
            face_varying: match options.face_varying {
                FaceVaryingInterpolation::None => "none",
                FaceVaryingInterpolation::CornersOnly => "corners only",
                FaceVaryingInterpolation::CornersPlus1 => "corners plus 1",
                FaceVaryingInterpolation::CornersPlus2 => "corners plus 2",
                FaceVaryingInterpolation::Boundaries => "boundaries",
                FaceVaryingInterpolation::All => "all",
            },
        }
    }

    fn to_text(&self) -> String {
        let counted = [
            (self.creases, "creased edges"),
            (self.corners, "sharp vertices"),
            (self.holes, "holes"),
            (self.edits, "hierarchical edits"),
        ];
        let mut parts: Vec<String> =
            counted.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        if self.edits > 0 {
            parts.push(format!("the deepest at level {}", self.deepest_edit_level));
        }
        if self.creases > 0 {
            parts.push(format!("{} creasing", self.creasing));
        }
        if self.triangles == "smooth" {
            parts.push("smooth triangles".to_owned());
        }
        if self.uv {
            parts.push(format!("texture coordinates (interpolation: {})", self.face_varying));
        }
        parts.extend(self.colors.map(|colors| format!("colours of vertices (interpolation: {colors})")));
        if parts.is_empty() { "none".to_owned() } else { parts.join(", ") }
    }
}

impl RefinementInfo {
    fn new(desc: &SurfaceDesc, made: &Preprocessed, wants_fixed_set: bool) -> Self {
        let tables = &made.tables;
        let counts = patch_counts(desc, made);
        let levels = tables.levels.iter().enumerate().map(|(level, points)| {
            let counts = counts.get(level).copied().unwrap_or_default();
            LevelInfo {
                points: points.points.len() as u64,
                regular: counts.regular,
                transition: counts.transition,
                quad: counts.filling,
                gregory_quad: counts.gregory,
                gregory_triangle: counts.triangle,
                table: counts.table,
            }
        });
        let point_bytes = size_of::<[f32; 3]>() as u64;
        Self {
            method: method_name(desc.method),
            level: tables.last_level,
            preprocess_ms: BTreeMap::from([("topology", made.times.topology), ("tables", made.times.tables)]),
            memory_bytes: BTreeMap::from([
                ("tables", table_bytes(tables)),
                ("points", point_bytes * u64::from(tables.point_count())),
            ]),
            gregory_stencils: StencilInfo::new(&tables.gregory),
            basis: BasisInfo::new(desc, made, wants_fixed_set),
            levels: levels.collect(),
        }
    }

    fn describe(&self, line: &mut impl FnMut(&str, String)) {
        let time = |name| milliseconds_text(self.preprocess_ms[name]);
        line("refinement", format!("{}, to level {}", self.method, self.level));
        line("  time", format!("{} ms topology, {} ms tables", time("topology"), time("tables")));
        let bytes = |name| bytes_text(self.memory_bytes[name]);
        line("  memory", format!("{} tables, {} points", bytes("tables"), bytes("points")));
        if let Some(StencilInfo { connectivities, faces, faces_of_spokes, bytes }) = &self.gregory_stencils {
            let stencils = format!("{connectivities} connectivities of {faces} faces, {}", bytes_text(*bytes));
            line("  stencils", format!("{stencils}; {faces_of_spokes} faces in two stages"));
        }
        if let Some(basis) = &self.basis {
            let own =
                format!("{} configurations of faces, {}", basis.configurations, bytes_text(basis.weight_bytes as u64));
            line("  tables", format!("{own} of weights; with edges and tangents {}", bytes_text(basis.bytes)));
            line("", format!("of faces, edges and vertices {} read from the cache, {} built", basis.read, basis.built));
            if let Some(fixed) = &basis.fixed_set {
                let (count, bytes) = (fixed.configurations, bytes_text(fixed.weight_bytes as u64));
                line(
                    "  fixed set",
                    format!("{count} configurations, valences 3 to 18 inside and on boundaries, {bytes}"),
                );
            }
        }
    }

    fn levels_table(&self) -> TextTable {
        if self.basis.is_some() {
            return self.grids_table();
        }
        let columns = ["level", "points", "regular", "transition", "quad", "Gregory quad", "Gregory triangle"];
        // Methods without Gregory patches have no columns for them.
        let count = if self.levels.iter().any(|level| level.gregory_quad + level.gregory_triangle > 0) {
            columns.len()
        } else {
            5
        };
        let mut table = TextTable::new(&columns[..count]);
        let mut sum = LevelInfo::default();
        let row = |name: String, level: &LevelInfo| {
            let counts = [level.regular, level.transition, level.quad, level.gregory_quad, level.gregory_triangle];
            let cells = [name, level.points.to_string()].into_iter().chain(counts.map(|count| count.to_string()));
            cells.take(count).collect::<Vec<_>>()
        };
        for (k, level) in self.levels.iter().enumerate() {
            table.push(row(k.to_string(), level));
            sum.points += level.points;
            sum.regular += level.regular;
            sum.transition += level.transition;
            sum.quad += level.quad;
            sum.gregory_quad += level.gregory_quad;
            sum.gregory_triangle += level.gregory_triangle;
        }
        table.push(row("all".to_owned(), &sum));
        table
    }
}

impl RefinementInfo {
    fn grids_table(&self) -> TextTable {
        let mut table = TextTable::new(&["level", "points", "table"]);
        for (level, info) in self.levels.iter().enumerate() {
            table.push(vec![level.to_string(), info.points.to_string(), info.table.to_string()]);
        }
        table
    }
}

impl BasisInfo {
    fn new(desc: &SurfaceDesc, made: &Preprocessed, wants_fixed_set: bool) -> Option<Self> {
        let tables = &made.tables;
        let options = desc.basis_options().filter(|options| options.has_weights)?;
        let own = TableSet::of(tables);
        let fixed = if wants_fixed_set { fixed_set(options.scheme, options.level).ok() } else { None };
        Some(Self {
            segments: 1 << options.level,
            configurations: own.configurations,
            weight_bytes: own.bytes(),
            bytes: basis_bytes(tables, desc.table_weights),
            read: made.basis_counts.read,
            built: made.basis_counts.built,
            fixed_set: fixed.map(|set| FixedSetInfo { configurations: set.configurations, weight_bytes: set.bytes() }),
        })
    }
}

/// Bytes of basis function tables on a device.
fn basis_bytes(tables: &Tables, stored: TableWeights) -> u64 {
    /// TablePatch and TableEdge of the shaders.
    const PATCH: usize = size_of::<[u32; 14]>();
    const EDGE: usize = size_of::<[u32; 3]>();
    let basis = &tables.basis;
    let weights = size_of_val(basis.weights.as_slice()) + size_of_val(basis.tangents.as_slice());
    let weights = if stored == TableWeights::Short { weights / 2 } else { weights };
    let lists = basis.patches.len() * PATCH + basis.edges.len() * EDGE + size_of_val(basis.controls.as_slice());
    (lists + weights) as u64
}

impl StencilInfo {
    fn new(table: &GregoryTable) -> Option<Self> {
        let stencils = &table.stencils;
        let drawn = table.faces.iter().zip(&stencils.faces).filter(|(face, _)| face.kind != GregoryKind::None);
        let (of_spokes, of_stencils): (Vec<_>, Vec<_>) = drawn.partition(|(_, stencil)| stencil.is_of_spokes());
        (!stencils.faces.is_empty()).then(|| Self {
            connectivities: stencils.connectivities.len(),
            faces: of_stencils.len(),
            faces_of_spokes: of_spokes.len(),
            bytes: stencil_bytes(table),
        })
    }
}

/// Patches of each level where every irregularity is isolated to the last one.
fn patch_counts(desc: &SurfaceDesc, made: &Preprocessed) -> Vec<PatchCounts> {
    let mut counts = vec![PatchCounts::default(); made.tables.last_level as usize + 1];
    if desc.method.is_grid() {
        counts[made.tables.last_level as usize].table = made.tables.basis.patches.len() as u32;
        return counts;
    }
    if desc.method == SurfaceMethod::Uniform {
        counts[made.tables.last_level as usize].filling = made.tables.filling.len() as u32;
        return counts;
    }
    for mesh in &made.meshes {
        for (sum, level) in counts.iter_mut().zip(deepest_cut(&made.tables, mesh).counts) {
            sum.regular += level.regular;
            sum.transition += level.transition;
            sum.filling += level.filling;
        }
    }
    // Of the leaves those that are Gregory patches.
    for (face, gregory) in made.tables.irregular.iter().zip(&made.tables.gregory.faces) {
        let level = usize::from(face.info.level);
        counts[level].filling -= u32::from(gregory.kind != GregoryKind::None);
        match gregory.kind {
            GregoryKind::Quad | GregoryKind::PartOfNgon => counts[level].gregory += 1,
            GregoryKind::PartOfTriangle(0) => counts[level - 1].triangle += 1,
            GregoryKind::PartOfTriangle(_) | GregoryKind::None => {}
        }
    }
    counts
}

/// Bytes of stencils of Gregory patches on a device.
fn stencil_bytes(table: &GregoryTable) -> u64 {
    let stencils = &table.stencils;
    let faces = stencils.faces.len() * STENCIL_BYTES;
    (faces + size_of_val(stencils.rings.as_slice()) + size_of_val(stencils.weights.as_slice())) as u64
}

/// Bytes of Gregory patches on a device: faces and stencils, and spokes if any are used.
fn gregory_bytes(table: &GregoryTable) -> u64 {
    let spokes = table.of_limit.len() * size_of::<[u32; 2]>()
        + table.spokes.len() * SPOKE_BYTES
        + table.rival_spokes.len() * RIVAL_SPOKE_BYTES
        + size_of_val(table.indices.as_slice())
        + size_of_val(table.weights.as_slice());
    let spokes = if table.needs_spokes() { spokes } else { 0 };
    (table.faces.len() * FACE_BYTES + spokes) as u64 + stencil_bytes(table)
}

/// Bytes that the tables take on a device.
pub fn table_bytes(tables: &Tables) -> u64 {
    /// First index, first weight and count.
    const ROW: usize = size_of::<[u32; 3]>();
    let info = size_of_val(&PatchInfo::default().pack());
    let lists = |lists: &IndexLists| size_of_val(lists.first.as_slice()) + size_of_val(lists.indices.as_slice());
    let (stencils, limits) = (&tables.stencils, &tables.limits);
    let bytes = [
        (stencils.rows.len() + limits.rows.len()) * ROW,
        size_of_val(stencils.indices.as_slice()),
        size_of_val(stencils.weights.as_slice()),
        size_of_val(limits.indices.as_slice()),
        size_of_val(limits.weights.as_slice()),
        tables.patches.len() * (size_of::<[u32; 16 + 1 + 4]>() + info),
        tables.irregular.len() * (size_of::<[u32; 4 * 5 + 1]>() + info),
        tables.filling.len() * (size_of::<[u32; 4]>() + info),
        size_of_val(tables.ptex_faces.as_slice()),
        lists(&tables.stars) + lists(&tables.slots.neighbours) + lists(&tables.slots.rings),
    ];
    bytes.iter().sum::<usize>() as u64 + gregory_bytes(&tables.gregory) + basis_bytes(tables, TableWeights::Float)
}

#[cfg(test)]
mod tests {
    use planish_subdiv::mesh::VertexColors;

    use super::*;

    #[test]
    fn histograms_read_as_a_sentence() {
        assert_eq!(histogram(&BTreeMap::from([(3, 8), (4, 20)]), "of", "sides"), "8 of 3 sides, 20 of 4 sides");
        assert_eq!(histogram(&BTreeMap::new(), "of", "sides"), "none");
    }

    #[test]
    fn features_name_what_is_there_alone() {
        let mut mesh = ControlMesh::default();
        assert_eq!(Features::new(&[&mesh], false).to_text(), "none");
        mesh.holes = vec![3, 4];
        assert_eq!(
            Features::new(&[&mesh], true).to_text(),
            "2 holes, texture coordinates (interpolation: corners plus 1)"
        );
        mesh.colors = Some(VertexColors { interpolation: VertexInterpolation::Varying, ..VertexColors::default() });
        assert_eq!(Features::new(&[&mesh], false).to_text(), "2 holes, colours of vertices (interpolation: varying)");
    }
}
