#include "vertex_errors.h"

#include "corner_domain.h"

#include <algorithm>
#include <cmath>

void WorstVertex::take(double other_error, size_t other_vertex, Vec3 other_expected) {
    const bool is_worse = other_error > error || (other_error == error && other_vertex < vertex);
    if (!is_worse)
        return;
    error = other_error;
    vertex = other_vertex;
    expected = other_expected;
}

void VertexErrors::merge(const VertexErrors& other) {
    position.take(other.position.error, other.position.vertex, other.position.expected);
    normal.take(other.normal.error, other.normal.vertex, other.normal.expected);
    position_count += other.position_count;
    normal_count += other.normal_count;
    position_square_sum += other.position_square_sum;
    normal_square_sum += other.normal_square_sum;
    largest_ordinary_position = std::max(largest_ordinary_position, other.largest_ordinary_position);
    tolerance_exceeded_count += other.tolerance_exceeded_count;
    largest_normal_ratio = std::max(largest_normal_ratio, other.largest_normal_ratio);
    normals_over_90_count += other.normals_over_90_count;
    for (int kind = 0; kind < point_kind_count; ++kind)
        kind_counts[kind] += other.kind_counts[kind];
    ambiguous_count += other.ambiguous_count;
    special_vs_mask = std::max(special_vs_mask, other.special_vs_mask);
    special_vs_diagonal = std::max(special_vs_diagonal, other.special_vs_diagonal);
    special_vs_nearest = std::max(special_vs_nearest, other.special_vs_nearest);
    oracle_degenerate_count += other.oracle_degenerate_count;
    dump_normal_bad_count += other.dump_normal_bad_count;
    nonfinite_count += other.nonfinite_count;
    without_limit_count += other.without_limit_count;
    bad_domain_count += other.bad_domain_count;
    pathological_count += other.pathological_count;
}

VertexErrors VertexComparer::errors() const {
    VertexErrors errors = errors_;
    errors.pathological_count = evaluator_.pathological_count();
    return errors;
}

// False where (u, v) is outside by more than float rounding.
bool VertexComparer::clamp_to_domain(double& u, double& v) const {
    const double slack = 1e-6;
    const bool in_square = u >= -slack && u <= 1 + slack && v >= -slack && v <= 1 + slack;
    if (!in_square || (is_triangle_ && u + v > 1 + slack))
        return false;
    u = std::clamp(u, 0.0, 1.0);
    v = std::clamp(v, 0.0, 1.0);
    if (is_triangle_ && u + v > 1) {
        const double sum = u + v;
        u /= sum;
        v /= sum;
    }
    return true;
}

void VertexComparer::add(size_t vertex) {
    double u = dump_.u[vertex], v = dump_.v[vertex];
    if (!clamp_to_domain(u, v)) {
        ++errors_.bad_domain_count;
        return;
    }
    const Vec3 position = dump_.position(vertex);
    if (!std::isfinite(position.x + position.y + position.z)) {
        ++errors_.nonfinite_count;
        return;
    }
    const Sample sample = evaluator_.evaluate((int)dump_.face[vertex], u, v);
    if (!sample.valid) {
        ++errors_.without_limit_count;
        return;
    }
    const double error = length(position - sample.position) / oracle_.extent().diagonal;
    ++errors_.position_count;
    errors_.position_square_sum += error * error;
    errors_.position.take(error, vertex, sample.position);
    if (sample.kind != PointKind::odd)
        errors_.largest_ordinary_position = std::max(errors_.largest_ordinary_position, error);

    ++errors_.kind_counts[(int)sample.kind];
    if (sample.kind == PointKind::ordinary)
        add_ordinary_normal(vertex, sample);
    else
        add_special_normal(vertex, u, v, sample);
}

static bool is_usable(Vec3 normal) {
    const double norm = length(normal);
    return std::isfinite(norm) && norm > 1e-6;
}

void VertexComparer::add_ordinary_normal(size_t vertex, const Sample& sample) {
    Vec3 expected;
    const Vec3 normal = dump_.normal(vertex);
    if (!normal_of(sample, oracle_.extent().diagonal, expected)) {
        ++errors_.oracle_degenerate_count;
        return;
    }
    if (!is_usable(normal)) {
        ++errors_.dump_normal_bad_count;
        return;
    }
    const double angle = angle_degrees(normal, expected);
    ++errors_.normal_count;
    errors_.normal_square_sum += angle * angle;
    errors_.normals_over_90_count += angle > 90;
    errors_.normal.take(angle, vertex, expected);

    const int base_face = oracle_.ptex_face((int)dump_.face[vertex]).base_face;
    const double ratio = angle / tolerance_.degrees(base_face, (int)dump_.level[vertex]);
    errors_.tolerance_exceeded_count += ratio > 1;
    errors_.largest_normal_ratio = std::max(errors_.largest_normal_ratio, ratio);
}

void VertexComparer::add_special_normal(size_t vertex, double u, double v, const Sample& sample) {
    const double diagonal = oracle_.extent().diagonal;
    const auto [near_u, near_v] = step_inside(u, v, std::ldexp(1.0, -50), is_triangle_);
    const Sample near = evaluator_.evaluate((int)dump_.face[vertex], near_u, near_v);
    Vec3 mask_normal, diagonal_normal;
    const bool has_mask = normal_of(sample, diagonal, mask_normal);
    const bool has_diagonal = normal_of(near, diagonal, diagonal_normal);
    if (!has_mask && !has_diagonal) {
        ++errors_.oracle_degenerate_count;
        return;
    }
    const Vec3 normal = dump_.normal(vertex);
    if (!is_usable(normal)) {
        ++errors_.dump_normal_bad_count;
        return;
    }
    if (!has_mask || !has_diagonal || angle_degrees(mask_normal, diagonal_normal) > .01)
        ++errors_.ambiguous_count;
    const double vs_mask = has_mask ? angle_degrees(normal, mask_normal) : 180;
    const double vs_diagonal = has_diagonal ? angle_degrees(normal, diagonal_normal) : 180;
    if (has_mask)
        errors_.special_vs_mask = std::max(errors_.special_vs_mask, vs_mask);
    if (has_diagonal)
        errors_.special_vs_diagonal = std::max(errors_.special_vs_diagonal, vs_diagonal);
    errors_.special_vs_nearest = std::max(errors_.special_vs_nearest, std::min(vs_mask, vs_diagonal));
}
