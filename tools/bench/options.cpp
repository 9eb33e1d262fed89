#include "options.h"

#include "../shared/fail.h"

static const char* const manual =
    "osd_bench: OpenSubdiv's own GL pipeline, timed offscreen: the peer.\n"
    "\n"
    "  osd_bench MESH.obj [options]\n"
    "\n"
    "Adaptive patches, compute stencils and hardware tessellation with OpenSubdiv's shaders; EGL surfaceless, GL 4.5\n"
    "core, RGBA8 with a 32-bit float depth. One line of JSON; see README.md for camera, light and animation.\n"
    "  -l ISOLATION                adaptive refinement to this level, 1 to 10 (2)\n"
    "  -t TESS                     tess factor of a patch of level 0, halved each level; never below 1, or 2 on\n"
    "                              transition edges (8)\n"
    "  --screen-space PIXELS       edges of about so many pixels instead of -t\n"
    "  --spacing equal|fractional_odd|fractional_even   OpenSubdiv honours the others with --screen-space only\n"
    "  --endcap gregory|bspline    (gregory)\n"
    "  --single-crease             single-crease patches\n"
    "  --cull                      OpenSubdiv's patch culling\n"
    "  --chunk N                   patches a draw call, 0: all; without it few enough for llvmpipe's faults: use 0 on\n"
    "                              a GPU\n"
    "  --frames N --warmup N       (10, 2)\n"
    "  --size W H --msaa N         (1280 720, 0)\n"
    "  --image OUT.ppm|OUT.png     the last frame\n"
    "  --cpu-only [--limit R]      tables alone, and limit stencils on an (R+1)^2 grid of each ptex face\n";

namespace {

bool take_table_option(Arguments& arguments, BenchOptions& options) {
    if (arguments.is("-l"))
        options.isolation = arguments.integer();
    else if (arguments.is("--single-crease"))
        options.single_crease = true;
    else if (arguments.is("--cpu-only"))
        options.cpu_only = true;
    else if (arguments.is("--limit"))
        options.limit_rate = arguments.integer();
    else if (arguments.is("--endcap")) {
        const std::string end_cap = arguments.value();
        options.use_bspline_end_caps = end_cap == "bspline";
        if (!options.use_bspline_end_caps && end_cap != "gregory")
            fail("--endcap gregory|bspline");
    } else
        return false;
    return true;
}

bool take_tessellation_option(Arguments& arguments, BenchOptions& options) {
    if (arguments.is("-t"))
        options.tess = arguments.number();
    else if (arguments.is("--screen-space"))
        options.screen_space_pixels = arguments.number();
    else if (arguments.is("--spacing"))
        options.spacing = arguments.value();
    else if (arguments.is("--cull"))
        options.cull = true;
    else if (arguments.is("--chunk"))
        options.chunk = arguments.integer();
    else
        return false;
    return true;
}

bool take_frame_option(Arguments& arguments, BenchOptions& options) {
    if (arguments.is("--frames"))
        options.frame_count = arguments.integer();
    else if (arguments.is("--warmup"))
        options.warmup_count = arguments.integer();
    else if (arguments.is("--image"))
        options.image = arguments.value();
    else if (arguments.is("--msaa"))
        options.sample_count = arguments.integer();
    else if (arguments.is("--size")) {
        options.width = arguments.integer();
        options.height = arguments.integer();
    } else
        return false;
    return true;
}

void check(const BenchOptions& options) {
    if (options.mesh.empty())
        fail("usage: osd_bench MESH.obj [-l ISOLATION] [-t TESS] .. (or --help)");
    if (options.isolation < 1 || options.isolation > 10)
        fail("-l is 1 to 10");
    const bool is_fractional = options.spacing == "fractional_odd" || options.spacing == "fractional_even";
    if (!is_fractional && options.spacing != "equal")
        fail("--spacing equal|fractional_odd|fractional_even");
    if (is_fractional && !options.is_screen_space())
        fail("OpenSubdiv honours fractional spacing with --screen-space only");
}

} // namespace

BenchOptions parse_options(int argc, char** argv) {
    BenchOptions options;
    Arguments arguments(argc, argv);
    while (arguments.next()) {
        if (arguments.is("--help"))
            print_manual((std::string(manual) + cage_options_manual).c_str());
        if (take_table_option(arguments, options) || take_tessellation_option(arguments, options) ||
            take_frame_option(arguments, options) || options.cage.take(arguments))
            continue;
        if (arguments.is_option())
            fail("unknown option " + arguments.word());
        options.mesh = arguments.word();
    }
    check(options);
    return options;
}
