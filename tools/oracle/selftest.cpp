#include "commands.h"
#include "uniform.h"

#include "../shared/json.h"
#include "../shared/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace OpenSubdiv;

namespace {

// The largest error and where it was, and the root of the mean square.
struct Errors {
    size_t count = 0;
    double largest = 0, square_sum = 0;
    int ptex = -1;
    std::array<double, 2> uv = {0, 0};

    void add(double error, int at_ptex, std::array<double, 2> at_uv) {
        ++count;
        square_sum += error * error;
        if (error <= largest)
            return;
        // Also where the error is NaN.
        largest = error;
        ptex = at_ptex;
        uv = at_uv;
    }
    double rms() const { return std::sqrt(square_sum / std::max<size_t>(count, 1)); }
    std::string where() const {
        return JsonObject().integer("face", ptex).number("u", uv[0], "%.17g").number("v", uv[1], "%.17g").str();
    }
};

struct Sharpness {
    bool is_semi_sharp, is_infinite;
};

Sharpness sharpness_at(const Far::TopologyLevel& level, int vertex) {
    Sharpness sharpness = {level.IsVertexSemiSharp(vertex), level.GetVertexSharpness(vertex) >= infinite_sharpness};
    Far::ConstIndexArray edges = level.GetVertexEdges(vertex);
    for (int k = 0; k < edges.size(); ++k) {
        sharpness.is_semi_sharp |= level.IsEdgeSemiSharp(edges[k]);
        sharpness.is_infinite |= level.IsEdgeInfSharp(edges[k]);
    }
    return sharpness;
}

// The faces with a limit, those of one base face side by side.
std::vector<int> faces_by_ptex(const LimitOracle& oracle, const UniformLimit& uniform) {
    std::vector<int> faces;
    for (int face = 0; face < uniform.last_level().GetNumFaces(); ++face) {
        const int ptex = uniform.domains[face].ptex;
        if (ptex >= 0 && oracle.ptex_face(ptex).has_limit)
            faces.push_back(face);
    }
    std::stable_sort(faces.begin(), faces.end(), [&](int a, int b) {
        return uniform.domains[a].ptex < uniform.domains[b].ptex;
    });
    return faces;
}

} // namespace

void selftest(const LimitOracle& oracle, int depth) {
    const UniformLimit uniform(oracle, depth);
    const Far::TopologyLevel& level = uniform.last_level();
    const double diagonal = oracle.extent().diagonal;
    LimitEvaluator evaluator(oracle);
    Errors positions, normals;
    size_t semi_sharp_count = 0;
    const Stopwatch stopwatch;
    for (int face : faces_by_ptex(oracle, uniform)) {
        const FaceDomain& domain = uniform.domains[face];
        Far::ConstIndexArray vertices = level.GetFaceVertices(face);
        for (int i = 0; i < vertices.size(); ++i) {
            const int vertex = vertices[i];
            const Sharpness sharpness = sharpness_at(level, vertex);
            if (sharpness.is_semi_sharp) {
                ++semi_sharp_count;
                continue;
            }
            const Sample sample = evaluator.evaluate(domain.ptex, domain.uv[i][0], domain.uv[i][1]);
            if (!sample.valid)
                continue;
            const double distance = length(sample.position - uniform.positions[vertex]);
            positions.add(distance / diagonal, domain.ptex, domain.uv[i]);

            Vec3 normal;
            const Vec3 mask_normal = uniform.normal(vertex);
            const bool comparable = !sharpness.is_infinite && !level.IsVertexNonManifold(vertex);
            if (comparable && normal_of(sample, diagonal, normal) && length(mask_normal) > 0)
                normals.add(angle_degrees(normal, mask_normal), domain.ptex, domain.uv[i]);
        }
    }
    JsonObject json;
    json.boolean("selftest", true).integer("level", depth);
    json.count("points", positions.count).count("skipped_semisharp", semi_sharp_count);
    json.number("max_pos", positions.largest, "%.3g").number("rms_pos", positions.rms(), "%.3g");
    json.json("worst_pos", positions.where()).count("normals", normals.count);
    json.number("max_normal_deg", normals.largest, "%.3g").number("rms_normal_deg", normals.rms(), "%.3g");
    json.json("worst_normal", normals.where()).number("seconds", stopwatch.seconds(), "%.3f");
    printf("%s\n", json.str().c_str());
}
