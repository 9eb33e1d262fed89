//! The pipelines of the passes: one for each kind of patch that a method draws, or of uniform refinement.

use planish_gpu::{
    DepthBias, DepthTest, Device, GraphicsPipeline, GraphicsPipelineDesc, PolygonMode, SpecConstant, Topology,
};
use planish_shaders as shaders;
use planish_shaders::{DrawPush, ShaderModule};
use planish_subdiv::gregory::Rival;

use crate::error::Error;
use crate::lists::PatchKind;
use crate::options::{EndCap, Spacing, SurfaceMethod, View};
use crate::program::stage;
use crate::targets::{DEPTH_FORMAT, Layers};

/// What a pass's last stage before rasterization makes: the shaders' variants `lean`, `layers` and `colors`, and `dump`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// What images with these layers need; with none the normal alone.
    Image(Layers),
    /// Captured by transform feedback.
    Dump,
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
    ];
    let view_constant =
        [SpecConstant { id: shaders::surface_lean_frag::SPEC_VIEW, bits: options.view.constant(options.method) }];
    let geometry = geometry_stages(options, kind);
    let used: Vec<Vec<SpecConstant>> = geometry
        .iter()
        .map(|module| {
            let knows = |constant: &&SpecConstant| module.spec_constants.iter().any(|known| known.id == constant.id);
            let is_patch = ["bspline_patch", "filling_quad", "gregory_patch", "acc_patch", "pm_patch", "uniform_quad"]
                .iter()
                .any(|stem| module.name.starts_with(stem));
            patch_constants.iter().filter(|_| is_patch).filter(knows).copied().collect()
        })
        .collect();
    let mut stages: Vec<_> = geometry.iter().zip(&used).map(|(module, used)| stage(module, used)).collect();
    if options.wire {
        stages.push(stage(&shaders::wire_frag::PROGRAM, &[]));
    } else {
        match options.output {
            Output::Image(layers) => stages.push(stage(fragment_stage(layers), &view_constant)),
            Output::Dump => {}
        }
    }
    let formats = match options.output {
        Output::Image(layers) => layers.color_formats(),
        Output::Dump => Vec::new(),
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

/// The stages before rasterization.
fn geometry_stages(options: &PipelineOptions, kind: PatchKind) -> Vec<&'static ShaderModule> {
    let pick = |lean, layers, colors, dump| match options.output {
        Output::Image(Layers::None) => lean,
        Output::Image(Layers::Geometry) => layers,
        Output::Image(Layers::GeometryAndColors) => colors,
        Output::Dump => dump,
    };
    if options.method == SurfaceMethod::Uniform {
        return vec![pick(
            &shaders::uniform_quad_lean_vert::PROGRAM,
            &shaders::uniform_quad_layers_vert::PROGRAM,
            &shaders::uniform_quad_colors_vert::PROGRAM,
            &shaders::uniform_quad_dump_vert::PROGRAM,
        )];
    }
    let list = &shaders::patch_list_vert::PROGRAM;
    if matches!(kind, PatchKind::Gregory | PatchKind::GregoryCut | PatchKind::Triangle | PatchKind::TriangleCut) {
        if let Some(rival) = options.method.rival() {
            return rival_stages(list, rival, pick);
        }
        let evaluation = if options.displaced {
            pick(
                &shaders::gregory_patch_lean_maps_tese::PROGRAM,
                &shaders::gregory_patch_layers_maps_tese::PROGRAM,
                &shaders::gregory_patch_colors_maps_tese::PROGRAM,
                &shaders::gregory_patch_dump_maps_tese::PROGRAM,
            )
        } else {
            pick(
                &shaders::gregory_patch_lean_tese::PROGRAM,
                &shaders::gregory_patch_layers_tese::PROGRAM,
                &shaders::gregory_patch_colors_tese::PROGRAM,
                &shaders::gregory_patch_dump_tese::PROGRAM,
            )
        };
        return vec![list, &shaders::gregory_patch_tesc::PROGRAM, evaluation];
    }
    if kind != PatchKind::Filling {
        let evaluation = if options.displaced {
            pick(
                &shaders::bspline_patch_lean_maps_tese::PROGRAM,
                &shaders::bspline_patch_layers_maps_tese::PROGRAM,
                &shaders::bspline_patch_colors_maps_tese::PROGRAM,
                &shaders::bspline_patch_dump_maps_tese::PROGRAM,
            )
        } else {
            pick(
                &shaders::bspline_patch_lean_tese::PROGRAM,
                &shaders::bspline_patch_layers_tese::PROGRAM,
                &shaders::bspline_patch_colors_tese::PROGRAM,
                &shaders::bspline_patch_dump_tese::PROGRAM,
            )
        };
        return vec![list, &shaders::bspline_patch_tesc::PROGRAM, evaluation];
    }
    let evaluation = pick(
        &shaders::filling_quad_lean_tese::PROGRAM,
        &shaders::filling_quad_layers_tese::PROGRAM,
        &shaders::filling_quad_colors_tese::PROGRAM,
        &shaders::filling_quad_dump_tese::PROGRAM,
    );
    vec![list, &shaders::filling_quad_tesc::PROGRAM, evaluation]
}

/// Those of ACC or Pm-patches; `pick` chooses by what they make.
fn rival_stages(
    list: &'static ShaderModule,
    rival: Rival,
    pick: impl Fn(
        &'static ShaderModule,
        &'static ShaderModule,
        &'static ShaderModule,
        &'static ShaderModule,
    ) -> &'static ShaderModule,
) -> Vec<&'static ShaderModule> {
    let (control, evaluation) = match rival {
        Rival::Acc => (
            &shaders::acc_patch_tesc::PROGRAM,
            pick(
                &shaders::acc_patch_lean_tese::PROGRAM,
                &shaders::acc_patch_layers_tese::PROGRAM,
                &shaders::acc_patch_colors_tese::PROGRAM,
                &shaders::acc_patch_dump_tese::PROGRAM,
            ),
        ),
        Rival::Pm => (
            &shaders::pm_patch_tesc::PROGRAM,
            pick(
                &shaders::pm_patch_lean_tese::PROGRAM,
                &shaders::pm_patch_layers_tese::PROGRAM,
                &shaders::pm_patch_colors_tese::PROGRAM,
                &shaders::pm_patch_dump_tese::PROGRAM,
            ),
        ),
    };
    vec![list, control, evaluation]
}

/// The stage after rasterization.
fn fragment_stage(layers: Layers) -> &'static ShaderModule {
    match layers {
        Layers::None => &shaders::surface_lean_frag::PROGRAM,
        Layers::Geometry => &shaders::surface_layers_frag::PROGRAM,
        Layers::GeometryAndColors => &shaders::surface_colors_frag::PROGRAM,
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
    }
}
