#pragma once

#include "dump.h"
#include "limit_oracle.h"
#include "vertex_errors.h"

// How far the s and t of a dump's vertices are from OpenSubdiv's limit, over the largest |s| or |t| of the cage.
struct StErrors {
    WorstVertex worst;
    double sum = 0;
    size_t count = 0;
    // Not compared: not finite, or of faces that cannot be cut out.
    size_t nonfinite_count = 0, pathological_count = 0;

    double mean() const { return count ? sum / (double)count : 0; }
    void merge(const StErrors& other);
};

// The vertices of a dump that has s and t, for a cage with values; those on faces without a limit are left out.
// `vertices` must name ptex faces that there are, those of one base face side by side.
StErrors compare_st(const LimitOracle& oracle, const Dump& dump, const std::vector<uint32_t>& vertices);
