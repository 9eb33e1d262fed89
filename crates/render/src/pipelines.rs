//! The pipelines of the passes: one for each kind of patch that a method draws, or of uniform refinement.

use planish_gpu::{
    DepthBias, DepthTest, Device, GraphicsPipeline, GraphicsPipelineDesc, PolygonMode, SpecConstant, Topology,
};
use planish_shaders as shaders;
use planish_shaders::{DrawPush, ShaderModule};
use planish_subdiv::gregory::Rival;

use crate::error::Error;
use crate::lists::PatchKind;
use crate::options::{EndCap, Spacing, SurfaceMethod, TableNormals, TableWeights, View};
use crate::program::stage;
use crate::targets::{DEPTH_FORMAT, Layers};

/// What a pass's last stage before rasterization makes: the shaders' variants `lean`, `layers`, `colors` and `shading`, and `dump`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// What images with these layers need; with none the normal alone.
    Image(Layers),
    /// Depth alone: `lean`, or `shading` where materials have holes.
    Depth,
    /// Captured by transform feedback.
    Dump,
}

/// The variants of a shader: lean, layers, colors, shading, dump.
type Variants = [&'static ShaderModule; 5];

/// The variant that makes what is asked for.
fn pick(options: &PipelineOptions, [lean, layers, colors, shading, dump]: Variants) -> &'static ShaderModule {
    match options.output {
        Output::Image(Layers::None) => lean,
        Output::Image(Layers::Geometry) => layers,
        Output::Image(Layers::GeometryAndColors) => colors,
        Output::Image(Layers::Shading) => shading,
        Output::Depth if options.cutouts => shading,
        Output::Depth => lean,
        Output::Dump => dump,
    }
}

/// What the pipelines are for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PipelineOptions {
    pub method: SurfaceMethod,
    pub end_cap: EndCap,
    pub spacing: Spacing,
    pub output: Output,
    pub view: View,
    pub cull_back: bool,
    pub wire: bool,
    /// Some regular patches have a semi-sharp crease.
    pub creases: bool,
    /// Some objects stand elsewhere than their mesh.
    pub placed: bool,
    /// Some patches are cut.
    pub cuts: bool,
    /// Seams have the same bits on both sides.
    pub watertight: bool,
    /// Some objects are displaced.
    pub displaced: bool,
    /// Texture coordinates are asked for.
    pub tex_coords: bool,
    /// Gregory patches are made of the cage's points.
    pub stencils: bool,
    /// Gregory patches have the normals of the rational patch.
    pub exact_normals: bool,
    /// Colours are asked for.
    pub colors: bool,
    /// It is asked where points are at the next moment.
    pub moves: bool,
    /// Some materials have holes.
    pub cutouts: bool,
    /// Where normals by table come from.
    pub table_normals: TableNormals,
    /// How weights of tables are stored.
    pub table_weights: TableWeights,
}

/// The pipeline of each kind of patch that the method has: each on a thread of its own, as drivers compile on the caller's.
pub(crate) fn pipelines(
    device: &Device,
    options: &PipelineOptions,
) -> Result<Vec<(PatchKind, GraphicsPipeline)>, Error> {
    let kinds =
        PatchKind::of_method(options.method, options.end_cap).iter().filter(|kind| options.cuts || !kind.is_cut());
    std::thread::scope(|scope| {
        let made: Vec<_> = kinds.map(|&kind| (kind, scope.spawn(move || pipeline(device, options, kind)))).collect();
        let joined = made.into_iter().map(|(kind, thread)| {
            let pipeline = thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            Ok((kind, pipeline?))
        });
        joined.collect()
    })
}

fn pipeline(device: &Device, options: &PipelineOptions, kind: PatchKind) -> Result<GraphicsPipeline, Error> {
    let patch_constants = [
        SpecConstant { id: shaders::bspline_patch_tesc::SPEC_SPACING, bits: options.spacing.constant() },
        SpecConstant {
            id: shaders::bspline_patch_lean_tese::SPEC_TRANSITION,
            bits: u32::from(matches!(kind, PatchKind::Transition | PatchKind::Cut)),
        },
        SpecConstant { id: shaders::bspline_patch_lean_tese::SPEC_CREASE, bits: u32::from(options.creases) },
        SpecConstant { id: shaders::bspline_patch_tesc::SPEC_PLACED, bits: u32::from(options.placed) },
        SpecConstant { id: shaders::bspline_patch_lean_tese::SPEC_WATERTIGHT, bits: u32::from(options.watertight) },
        SpecConstant { id: shaders::bspline_patch_lean_tese::SPEC_DISPLACED, bits: u32::from(options.displaced) },
        SpecConstant { id: shaders::bspline_patch_lean_tese::SPEC_TEX_COORDS, bits: u32::from(options.tex_coords) },
        SpecConstant { id: shaders::bspline_patch_lean_tese::SPEC_CUT, bits: u32::from(kind.is_cut()) },
        SpecConstant {
            id: shaders::gregory_patch_lean_tese::SPEC_TRIANGLE,
            bits: u32::from(matches!(kind, PatchKind::Triangle | PatchKind::TriangleCut)),
        },
        SpecConstant {
            id: shaders::gregory_patch_lean_tese::SPEC_EXACT_NORMALS,
            bits: u32::from(options.exact_normals),
        },
        SpecConstant { id: shaders::gregory_patch_tesc::SPEC_STENCIL, bits: u32::from(options.stencils) },
        SpecConstant { id: shaders::bspline_patch_lean_tese::SPEC_COLORED, bits: u32::from(options.colors) },
        SpecConstant { id: shaders::bspline_patch_colors_tese::SPEC_MOVING, bits: u32::from(options.moves) },
        SpecConstant { id: shaders::table_patch_lean_tese::SPEC_EVALUATE, bits: evaluation(options.method) },
        SpecConstant { id: shaders::table_patch_lean_tese::SPEC_NORMALS, bits: table_normals(options.table_normals) },
        SpecConstant {
            id: shaders::table_patch_lean_tese::SPEC_SHORT_WEIGHTS,
            bits: u32::from(options.table_weights == TableWeights::Short),
        },
    ];
    let fragment = fragment_stage(options);
    let fragment_constants = [
        SpecConstant { id: shaders::surface_lean_frag::SPEC_VIEW, bits: options.view.constant(options.method) },
        SpecConstant { id: shaders::surface_shading_frag::SPEC_TEX_COORDS, bits: u32::from(options.tex_coords) },
    ];
    let fragment_constants: Vec<SpecConstant> = fragment_constants
        .into_iter()
        .filter(|constant| fragment.is_some_and(|module| knows(module, constant)))
        .collect();
    let geometry = geometry_stages(options, kind);
    let used: Vec<Vec<SpecConstant>> = geometry
        .iter()
        .map(|module| {
            let is_patch = [
                "bspline_patch",
                "filling_quad",
                "gregory_patch",
                "acc_patch",
                "pm_patch",
                "uniform_quad",
                "table_patch",
            ]
            .iter()
            .any(|stem| module.name.starts_with(stem));
            patch_constants.iter().filter(|constant| is_patch && knows(module, constant)).copied().collect()
        })
        .collect();
    let mut stages: Vec<_> = geometry.iter().zip(&used).map(|(module, used)| stage(module, used)).collect();
    stages.extend(fragment.map(|module| stage(module, &fragment_constants)));
    let formats = match options.output {
        Output::Image(layers) => layers.color_formats(),
        Output::Depth | Output::Dump => Vec::new(),
    };
    let is_dump = options.output == Output::Dump;
    Ok(GraphicsPipeline::new(
        device,
        &GraphicsPipelineDesc {
            name: pass_name(options, kind),
            stages: &stages,
            push_size: size_of::<DrawPush>() as u32,
            topology: match options.method {
                SurfaceMethod::Uniform => Topology::Triangles,
                _ => Topology::Patches { control_points: 1 },
            },
            color_formats: &formats,
            depth_format: (!is_dump).then_some(DEPTH_FORMAT),
            depth_test: if is_dump { DepthTest::Off } else { DepthTest::GreaterOrEqual },
            depth_write: !is_dump,
            // Depth grows towards the eye: lines win over the triangles that they bound.
            depth_bias: options.wire.then_some(DepthBias { constant: 4.0, slope: 1.0 }),
            polygon_mode: if options.wire { PolygonMode::Line } else { PolygonMode::Fill },
            cull_back: options.cull_back,
            rasterizer_discard: is_dump,
        },
    )?)
}

/// EVALUATE_.. of `glsl/shared/substitutes.glsl`.
fn evaluation(method: SurfaceMethod) -> u32 {
    match method {
        SurfaceMethod::Flat => 1,
        SurfaceMethod::Phong => 2,
        SurfaceMethod::Pn => 3,
        _ => 0,
    }
}

/// NORMALS_.. of `glsl/shared/table_rows.glsl`.
fn table_normals(normals: TableNormals) -> u32 {
    match normals {
        TableNormals::Tangents => 0,
        TableNormals::Subdivision(_) => 1,
        TableNormals::Geometric => 2,
    }
}

/// The stages before rasterization.
fn geometry_stages(options: &PipelineOptions, kind: PatchKind) -> Vec<&'static ShaderModule> {
    if options.method == SurfaceMethod::Uniform {
        return vec![pick(
            options,
            [
                &shaders::uniform_quad_lean_vert::PROGRAM,
                &shaders::uniform_quad_layers_vert::PROGRAM,
                &shaders::uniform_quad_colors_vert::PROGRAM,
                &shaders::uniform_quad_shading_vert::PROGRAM,
                &shaders::uniform_quad_dump_vert::PROGRAM,
            ],
        )];
    }
    let list = &shaders::patch_list_vert::PROGRAM;
    if kind == PatchKind::Table {
        let evaluation = pick(
            options,
            [
                &shaders::table_patch_lean_tese::PROGRAM,
                &shaders::table_patch_layers_tese::PROGRAM,
                &shaders::table_patch_colors_tese::PROGRAM,
                &shaders::table_patch_shading_tese::PROGRAM,
                &shaders::table_patch_dump_tese::PROGRAM,
            ],
        );
        return vec![list, &shaders::table_patch_tesc::PROGRAM, evaluation];
    }
    if matches!(kind, PatchKind::Gregory | PatchKind::GregoryCut | PatchKind::Triangle | PatchKind::TriangleCut) {
        if let Some(rival) = options.method.rival() {
            return rival_stages(list, rival, options);
        }
        let evaluation = if options.displaced {
            pick(
                options,
                [
                    &shaders::gregory_patch_lean_maps_tese::PROGRAM,
                    &shaders::gregory_patch_layers_maps_tese::PROGRAM,
                    &shaders::gregory_patch_colors_maps_tese::PROGRAM,
                    &shaders::gregory_patch_shading_maps_tese::PROGRAM,
                    &shaders::gregory_patch_dump_maps_tese::PROGRAM,
                ],
            )
        } else {
            pick(
                options,
                [
                    &shaders::gregory_patch_lean_tese::PROGRAM,
                    &shaders::gregory_patch_layers_tese::PROGRAM,
                    &shaders::gregory_patch_colors_tese::PROGRAM,
                    &shaders::gregory_patch_shading_tese::PROGRAM,
                    &shaders::gregory_patch_dump_tese::PROGRAM,
                ],
            )
        };
        return vec![list, &shaders::gregory_patch_tesc::PROGRAM, evaluation];
    }
    if kind != PatchKind::Filling {
        let evaluation = if options.displaced {
            pick(
                options,
                [
                    &shaders::bspline_patch_lean_maps_tese::PROGRAM,
                    &shaders::bspline_patch_layers_maps_tese::PROGRAM,
                    &shaders::bspline_patch_colors_maps_tese::PROGRAM,
                    &shaders::bspline_patch_shading_maps_tese::PROGRAM,
                    &shaders::bspline_patch_dump_maps_tese::PROGRAM,
                ],
            )
        } else {
            pick(
                options,
                [
                    &shaders::bspline_patch_lean_tese::PROGRAM,
                    &shaders::bspline_patch_layers_tese::PROGRAM,
                    &shaders::bspline_patch_colors_tese::PROGRAM,
                    &shaders::bspline_patch_shading_tese::PROGRAM,
                    &shaders::bspline_patch_dump_tese::PROGRAM,
                ],
            )
        };
        return vec![list, &shaders::bspline_patch_tesc::PROGRAM, evaluation];
    }
    let evaluation = pick(
        options,
        [
            &shaders::filling_quad_lean_tese::PROGRAM,
            &shaders::filling_quad_layers_tese::PROGRAM,
            &shaders::filling_quad_colors_tese::PROGRAM,
            &shaders::filling_quad_shading_tese::PROGRAM,
            &shaders::filling_quad_dump_tese::PROGRAM,
        ],
    );
    vec![list, &shaders::filling_quad_tesc::PROGRAM, evaluation]
}

/// Those of ACC or Pm-patches.
fn rival_stages(list: &'static ShaderModule, rival: Rival, options: &PipelineOptions) -> Vec<&'static ShaderModule> {
    let (control, evaluation) = match rival {
        Rival::Acc => (
            &shaders::acc_patch_tesc::PROGRAM,
            pick(
                options,
                [
                    &shaders::acc_patch_lean_tese::PROGRAM,
                    &shaders::acc_patch_layers_tese::PROGRAM,
                    &shaders::acc_patch_colors_tese::PROGRAM,
                    &shaders::acc_patch_shading_tese::PROGRAM,
                    &shaders::acc_patch_dump_tese::PROGRAM,
                ],
            ),
        ),
        Rival::Pm => (
            &shaders::pm_patch_tesc::PROGRAM,
            pick(
                options,
                [
                    &shaders::pm_patch_lean_tese::PROGRAM,
                    &shaders::pm_patch_layers_tese::PROGRAM,
                    &shaders::pm_patch_colors_tese::PROGRAM,
                    &shaders::pm_patch_shading_tese::PROGRAM,
                    &shaders::pm_patch_dump_tese::PROGRAM,
                ],
            ),
        ),
    };
    vec![list, control, evaluation]
}

/// Whether a shader has a specialization constant.
fn knows(module: &ShaderModule, constant: &SpecConstant) -> bool {
    module.spec_constants.iter().any(|known| known.id == constant.id)
}

/// The stage after rasterization, if there is one.
fn fragment_stage(options: &PipelineOptions) -> Option<&'static ShaderModule> {
    if options.wire {
        return Some(&shaders::wire_frag::PROGRAM);
    }
    match options.output {
        Output::Image(Layers::None) => Some(&shaders::surface_lean_frag::PROGRAM),
        Output::Image(Layers::Geometry) => Some(&shaders::surface_layers_frag::PROGRAM),
        Output::Image(Layers::GeometryAndColors) => Some(&shaders::surface_colors_frag::PROGRAM),
        Output::Image(Layers::Shading) if options.cutouts => Some(&shaders::surface_cutout_frag::PROGRAM),
        Output::Image(Layers::Shading) => Some(&shaders::surface_shading_frag::PROGRAM),
        Output::Depth => options.cutouts.then_some(&shaders::surface_shadow_cutout_frag::PROGRAM),
        Output::Dump => None,
    }
}

fn pass_name(options: &PipelineOptions, kind: PatchKind) -> &'static str {
    match (options.method, kind) {
        (SurfaceMethod::Uniform, _) => "uniform quads",
        (_, PatchKind::Regular) => "regular patches",
        (_, PatchKind::Transition) => "transition patches",
        (_, PatchKind::Filling) => "filling quads",
        (_, PatchKind::Cut) => "cut patches",
        (SurfaceMethod::Acc, PatchKind::Gregory) => "ACC patches",
        (SurfaceMethod::Acc, PatchKind::GregoryCut) => "cut ACC patches",
        (SurfaceMethod::Pm, PatchKind::Gregory) => "Pm-patches",
        (SurfaceMethod::Pm, PatchKind::GregoryCut) => "cut Pm-patches",
        (_, PatchKind::Gregory) => "Gregory quads",
        (_, PatchKind::GregoryCut) => "cut Gregory quads",
        (_, PatchKind::Triangle) => "Gregory triangles",
        (_, PatchKind::TriangleCut) => "cut Gregory triangles",
        (SurfaceMethod::Flat, PatchKind::Table) => "flat faces",
        (SurfaceMethod::Phong, PatchKind::Table) => "Phong tessellation",
        (SurfaceMethod::Pn, PatchKind::Table) => "PN triangles",
        (_, PatchKind::Table) => "table patches",
    }
}
