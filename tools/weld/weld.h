#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

// The bits of x y z nx ny nz, with -0 as 0.
using VertexBits = std::array<uint32_t, 6>;

struct Soup {
    std::vector<VertexBits> vertices;
    // Three vertex indices each.
    std::vector<uint32_t> triangles;
    bool has_normals = false;
    // NaN or infinite coordinates.
    size_t nonfinite_count = 0;
};

// Fails where a triangle names a vertex that is not there, or vertices have no position.
Soup read_soup(const std::string& path);

// How many of the six words of a vertex must be equal for two vertices to be one.
enum class WeldBy { position = 3, position_and_normal = 6 };

// Counts after welding. A triangle with two equal corners is dropped as collapsed before edges are counted.
struct WeldReport {
    size_t vertex_count = 0;
    size_t triangle_count = 0;
    size_t collapsed_count = 0;
    // Among `triangle_count`: the corners lie on one line, area exactly 0 in double.
    size_t zero_area_count = 0;
    // Undirected edges, by the number of triangles at them.
    size_t edges_once = 0;
    size_t edges_twice = 0;
    size_t edges_over_twice = 0;
    // Edges of two triangles that run the same way in both.
    size_t twice_same_direction = 0;
    // Edges of more triangles that do not run either way equally often.
    size_t over_twice_unbalanced = 0;
    size_t component_count = 0;
    size_t boundary_component_count = 0;
    // V - E + F.
    long euler = 0;
    // The two ends of the first edge used once, if any.
    std::vector<std::array<float, 3>> first_open_edge;
};

WeldReport weld(const Soup& soup, WeldBy by);
