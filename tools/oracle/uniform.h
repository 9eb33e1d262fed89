#pragma once

#include "limit_oracle.h"

#include <array>
#include <memory>
#include <vector>

// Where a face of a refined level lies on the base mesh; `ptex` is -1 for an n-gon of the base level.
struct FaceDomain {
    int ptex = -1;
    // Of each corner.
    std::array<std::array<double, 2>, 4> uv;
};

// A cage after `level` uniform subdivisions in double, its limit by masks, and the place of every face.
struct UniformLimit {
    UniformLimit(const LimitOracle& oracle, int level);

    const OpenSubdiv::Far::TopologyLevel& last_level() const { return refiner->GetLevel(level); }

    int level;
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner;
    // Of each vertex of the last level.
    std::vector<Vec3> positions, tangents_u, tangents_v;
    // Of each face of the last level.
    std::vector<FaceDomain> domains;

    // Its sides are one-sided masks at sharp vertices: that is OpenSubdiv's answer.
    Vec3 normal(int vertex) const { return cross(tangents_u[vertex], tangents_v[vertex]); }
};
