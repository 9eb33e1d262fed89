#pragma once

#include <cstdint>
#include <string>
#include <vector>

// One property of the vertices; `values` is empty where the file does not have it.
template <class T>
struct PlyColumn {
    std::string name;
    bool present = false;
    std::vector<T> values;
};

struct PlyFile {
    size_t vertex_count = 0;
    // In the order asked for.
    std::vector<PlyColumn<float>> floats;
    std::vector<PlyColumn<int64_t>> integers;
    // Three vertex indices each, unchecked; a larger face is a fan around its first vertex.
    std::vector<uint32_t> triangles;
};

// Reads the named vertex properties and the faces of a PLY file, ascii or binary little-endian; all else is skipped.
// Values are converted from whatever type the file holds. Fails on a file that is none, or is cut short.
PlyFile read_ply(const std::string& path, const std::vector<std::string>& float_names,
                 const std::vector<std::string>& integer_names);
