#pragma once

#include "options.h"
#include "timings.h"

#include <opensubdiv/far/patchTable.h>
#include <opensubdiv/far/stencilTable.h>

#include <map>
#include <memory>
#include <string>

// What OpenSubdiv prepares on the CPU for drawing a cage.
struct Tables {
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner;
    std::unique_ptr<const OpenSubdiv::Far::PatchTable> patches;
    // From the cage to all refined and local points.
    std::unique_ptr<const OpenSubdiv::Far::StencilTable> stencils;
    size_t limit_stencil_count = 0;

    int point_count() const { return refiner->GetNumVerticesTotal() + patches->GetNumLocalPoints(); }
    std::map<std::string, int> patch_counts_by_type() const;
};

// Times each stage.
Tables make_tables(const Cage& cage, const BenchOptions& options, Timings& timings);
