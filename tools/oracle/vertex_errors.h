#pragma once

#include "dump.h"
#include "limit_oracle.h"
#include "normal_tolerance.h"

// The largest error, its vertex in the dump (the first one, of equals) and what the oracle says there.
struct WorstVertex {
    double error = -1;
    size_t vertex = 0;
    Vec3 expected;

    void take(double other_error, size_t other_vertex, Vec3 other_expected);
};

// Sums over the vertices of a dump. Position errors are divided by the diagonal of the cage, angles are in degrees.
struct VertexErrors {
    WorstVertex position, normal;
    size_t position_count = 0, normal_count = 0;
    double position_square_sum = 0, normal_square_sum = 0;
    // Without the odd points, where the usual limit masks are inexact.
    double largest_ordinary_position = 0;

    // Normals beyond the tolerance, and the largest error in units of it.
    size_t tolerance_exceeded_count = 0;
    double largest_normal_ratio = 0;
    size_t normals_over_90_count = 0;

    // By PointKind.
    size_t kind_counts[point_kind_count] = {};
    // At points that are not ordinary, where the dump's normal is compared with the oracle's, with its limit along the
    // face's diagonal, and with the nearer of the two. Ambiguous: those two differ.
    size_t ambiguous_count = 0;
    double special_vs_mask = 0, special_vs_diagonal = 0, special_vs_nearest = 0;

    // Not compared, and why.
    size_t oracle_degenerate_count = 0, dump_normal_bad_count = 0, nonfinite_count = 0;
    size_t without_limit_count = 0, bad_domain_count = 0;
    size_t pathological_count = 0;

    void merge(const VertexErrors& other);
};

// Compares vertices of one dump, on one thread.
class VertexComparer {
public:
    VertexComparer(const LimitOracle& oracle, const Dump& dump, const NormalTolerance& tolerance)
        : oracle_(oracle), dump_(dump), tolerance_(tolerance), evaluator_(oracle),
          is_triangle_(oracle.cage().is_loop()) {}

    // The vertex must name a ptex face that there is.
    void add(size_t vertex);
    VertexErrors errors() const;

private:
    bool clamp_to_domain(double& u, double& v) const;
    void add_ordinary_normal(size_t vertex, const Sample& sample);
    void add_special_normal(size_t vertex, double u, double v, const Sample& sample);

    const LimitOracle& oracle_;
    const Dump& dump_;
    const NormalTolerance& tolerance_;
    LimitEvaluator evaluator_;
    bool is_triangle_;
    VertexErrors errors_;
};
