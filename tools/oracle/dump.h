#pragma once

#include "../osd/vec3.h"

#include <cstdint>
#include <string>
#include <vector>

// A triangle soup over the limit surface: what `planish dump` writes.
struct Dump {
    // A column for each vertex property.
    std::vector<float> x, y, z, nx, ny, nz, u, v;
    // Face-varying values; empty where the file has none.
    std::vector<float> s, t;
    // Ptex face, and the subdivision level of the patch (0 where the file does not say).
    std::vector<int64_t> face, level;
    std::vector<uint32_t> triangles;

    size_t vertex_count() const { return x.size(); }
    Vec3 position(size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3 normal(size_t i) const { return {nx[i], ny[i], nz[i]}; }

    // Appends a vertex, with its normal made a unit one, and returns its index.
    uint32_t add(Vec3 position, Vec3 normal, double u, double v, int ptex);
    void add_triangle(uint32_t a, uint32_t b, uint32_t c) { triangles.insert(triangles.end(), {a, b, c}); }
};

// Fails where a vertex property other than `level`, `s` and `t` is missing.
Dump read_dump(const std::string& path);
// Without `level`, `s` and `t`.
void write_dump(const std::string& path, const Dump& dump, bool ascii);
