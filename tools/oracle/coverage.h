#pragma once

#include "dump.h"
#include "limit_oracle.h"

// How the triangles of a dump cover the parameter domain of each ptex face that has a limit.
struct Coverage {
    size_t faces_without_limit = 0;
    // Faces that no vertex names, and the first of them.
    size_t uncovered_count = 0;
    int first_uncovered = -1;
    // Of a face's covered area from the area of its domain: the largest deviation, its face, faces with over 1e-5.
    double largest_deviation = 0;
    int worst_face = -1;
    size_t off_count = 0;
    // Triangles that run clockwise in (u, v), that have no area there, whose corners name different faces (they count
    // for none), and that name a vertex that is not there.
    size_t flipped_count = 0, zero_count = 0, mixed_count = 0, bad_index_count = 0;
};

Coverage coverage_of(const LimitOracle& oracle, const Dump& dump);
