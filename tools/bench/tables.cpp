#include "tables.h"

#include "../shared/fail.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>

using namespace OpenSubdiv;

static std::unique_ptr<const Far::StencilTable> make_stencils(const Tables& tables) {
    Far::StencilTableFactory::Options options;
    options.generateOffsets = true;
    options.generateIntermediateLevels = true;
    std::unique_ptr<const Far::StencilTable> stencils(Far::StencilTableFactory::Create(*tables.refiner, options));
    if (const Far::StencilTable* local = tables.patches->GetLocalPointStencilTable()) {
        // Null where there is nothing to append.
        const Far::StencilTable* both =
            Far::StencilTableFactory::AppendLocalPointStencilTable(*tables.refiner, stencils.get(), local);
        if (both)
            stencils.reset(both);
    }
    return stencils;
}

static size_t count_limit_stencils(const Far::TopologyRefiner& refiner, int rate, bool is_triangle, Timings& timings) {
    std::vector<float> u, v;
    for (int j = 0; j <= rate; ++j)
        for (int i = 0; i <= (is_triangle ? rate - j : rate); ++i) {
            u.push_back((float)i / rate);
            v.push_back((float)j / rate);
        }
    Far::LimitStencilTableFactory::LocationArrayVec locations(Far::PtexIndices(refiner).GetNumFaces());
    for (size_t face = 0; face < locations.size(); ++face) {
        locations[face].ptexIdx = (int)face;
        locations[face].numLocations = (int)u.size();
        locations[face].s = u.data();
        locations[face].t = v.data();
    }
    timings.skip();
    std::unique_ptr<const Far::LimitStencilTable> stencils(Far::LimitStencilTableFactory::Create(refiner, locations));
    timings.lap("limit_stencils");
    return stencils->GetNumStencils();
}

Tables make_tables(const Cage& cage, const BenchOptions& options, Timings& timings) {
    Tables tables;
    timings.skip();
    tables.refiner = make_refiner(cage);
    if (!tables.refiner)
        fail("OpenSubdiv rejected the mesh");
    timings.lap("refiner");

    using Options = Far::PatchTableFactory::Options;
    Options patch_options(options.isolation);
    patch_options.useSingleCreasePatch = options.single_crease;
    patch_options.useInfSharpPatch = true;
    patch_options.endCapType =
        options.use_bspline_end_caps ? Options::ENDCAP_BSPLINE_BASIS : Options::ENDCAP_GREGORY_BASIS;
    tables.refiner->RefineAdaptive(patch_options.GetRefineAdaptiveOptions());
    timings.lap("refine_adaptive");
    tables.patches.reset(Far::PatchTableFactory::Create(*tables.refiner, patch_options));
    timings.lap("patch_table");
    tables.stencils = make_stencils(tables);
    timings.lap("stencil_table");

    if (options.cpu_only && options.limit_rate > 0)
        tables.limit_stencil_count = count_limit_stencils(*tables.refiner, options.limit_rate, cage.is_loop(), timings);
    return tables;
}

std::map<std::string, int> Tables::patch_counts_by_type() const {
    // In the order of Far::PatchDescriptor::Type.
    static const char* const names[] = {"non_patch",        "points",        "lines",           "quads",
                                        "triangles",        "loop",          "regular",         "gregory",
                                        "gregory_boundary", "gregory_basis", "gregory_triangle"};
    std::map<std::string, int> counts;
    for (int i = 0; i < patches->GetNumPatchArrays(); ++i)
        counts[names[patches->GetPatchArrayDescriptor(i).GetType()]] += patches->GetNumPatches(i);
    return counts;
}
