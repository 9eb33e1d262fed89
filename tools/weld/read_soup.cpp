#include "weld.h"

#include "../shared/fail.h"
#include "../shared/ply.h"

#include <cmath>
#include <cstring>

Soup read_soup(const std::string& path) {
    PlyFile file = read_ply(path, {"x", "y", "z", "nx", "ny", "nz"}, {});
    auto have = [&](int first) {
        return file.floats[first].present && file.floats[first + 1].present && file.floats[first + 2].present;
    };
    if (!have(0))
        fail("a vertex needs x y z");

    Soup soup;
    soup.has_normals = have(3);
    soup.vertices.resize(file.vertex_count);
    for (size_t k = 0; k < file.floats.size(); ++k) {
        const std::vector<float>& values = file.floats[k].values;
        for (size_t i = 0; i < values.size(); ++i) {
            if (k < 3 && !std::isfinite(values[i]))
                ++soup.nonfinite_count;
            float value = values[i] == 0 ? 0.0f : values[i]; // -0 is 0
            memcpy(&soup.vertices[i][k], &value, sizeof value);
        }
    }
    soup.triangles = std::move(file.triangles);
    for (uint32_t index : soup.triangles)
        if (index >= soup.vertices.size())
            fail("a triangle refers to a vertex that is not there");
    return soup;
}
