#include "options.h"
#include "renderer.h"
#include "tables.h"
#include "timings.h"

#include "../shared/json.h"

#include <cstdio>
#include <cstdlib>

static void add_options(JsonObject& json, const BenchOptions& options, const Cage& cage) {
    json.text("mesh", options.mesh.substr(options.mesh.find_last_of('/') + 1));
    json.integer("faces", cage.face_count()).count("vertices", cage.points.size());
    json.integer("isolation", options.isolation);
    json.number("tess", options.is_screen_space() ? 0 : options.tess, "%g");
    json.text("endcap", options.use_bspline_end_caps ? "bspline" : "gregory");
    json.boolean("single_crease", options.single_crease);
    json.number("screen_space_pix", options.screen_space_pixels, "%g");
    json.text("spacing", options.spacing);
}

static void add_tables(JsonObject& json, const Tables& tables) {
    JsonObject by_type;
    for (const auto& [type, count] : tables.patch_counts_by_type())
        by_type.integer(type.c_str(), count);
    json.integer("patches", tables.patches->GetNumPatchesTotal()).json("patches_by_type", by_type.str());
    json.integer("refined_vertices", tables.refiner->GetNumVerticesTotal());
    json.integer("local_points", tables.patches->GetNumLocalPoints());
    json.count("stencil_weights", tables.stencils->GetWeights().size());
    json.count("limit_stencils", tables.limit_stencil_count);
}

static void add_frames(JsonObject& json, const FrameReport& report) {
    json.count("frames", report.total_ms.size());
    json.number("update_refine_ms", median(report.refine_ms), "%.3f");
    json.number("draw_ms", median(report.draw_ms), "%.3f");
    json.number("total_ms", median(report.total_ms), "%.3f");
    json.count("primitives", report.primitive_count);
    json.count("covered_pixels", report.covered_pixel_count);
    json.text("renderer", report.renderer);
}

int main(int argc, char** argv) {
    const BenchOptions options = parse_options(argc, argv);
    Timings timings;
    const Cage cage = read_cage(options.mesh, options.cage);
    timings.lap("load_obj");
    const Tables tables = make_tables(cage, options, timings);
    FrameReport report;
    if (!options.cpu_only)
        report = render_frames(cage, tables, options, timings);

    JsonObject json;
    add_options(json, options, cage);
    json.json("preprocess_ms", timings.json());
    json.number("preprocess_total_ms", timings.preprocess_total(), "%.2f");
    add_tables(json, tables);
    if (!options.cpu_only)
        add_frames(json, report);
    json.number("peak_rss_mib", peak_resident_mib(), "%.1f");
    printf("%s\n", json.str().c_str());

    // Mesa's own teardown may crash once the program's objects are gone.
    fflush(stdout);
    _Exit(0);
}
