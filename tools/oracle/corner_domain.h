#pragma once

#include <array>

// The parameter domain of a ptex face: the unit square, or for Loop the triangle below its diagonal.
inline int corner_count(bool is_triangle) {
    return is_triangle ? 3 : 4;
}

inline std::array<double, 2> corner_uv(int corner, bool is_triangle) {
    if (is_triangle)
        return {corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0};
    return {corner == 1 || corner == 2 ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0};
}

// From any point of the domain a step inside; from a corner, along the diagonal.
inline std::array<double, 2> step_inside(double u, double v, double step, bool is_triangle) {
    if (is_triangle)
        return {u + step * (1 - 3 * u), v + step * (1 - 3 * v)}; // towards the middle, where u = v = 1/3
    return {u + (u > 0 ? -step : step), v + (v > 0 ? -step : step)};
}

// The point `a` along u and `b` along v away from a corner into a square; for a triangle, `a` towards the next corner
// and `b` towards the one after it.
inline std::array<double, 2> into_domain(int corner, double a, double b, bool is_triangle) {
    const auto [u, v] = corner_uv(corner, is_triangle);
    if (!is_triangle)
        return {u + (u > 0 ? -a : a), v + (v > 0 ? -b : b)};
    if (corner == 0)
        return {a, b};
    return corner == 1 ? std::array<double, 2>{1 - a - b, a} : std::array<double, 2>{b, 1 - a - b};
}
