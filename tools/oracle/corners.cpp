#include "commands.h"
#include "corner_domain.h"
#include "one_ring.h"

#include "../shared/json.h"
#include "../shared/stopwatch.h"

#include <cmath>
#include <cstdio>

namespace {

// Of the corners of one kind: how far apart the two ways are.
struct CornerErrors {
    size_t count = 0, normal_count = 0, degenerate_count = 0;
    double largest_position = 0, largest_angle = 0;
    // Ptex face and corner.
    double position_at[2] = {-1, 0}, normal_at[2] = {-1, 0};

    void add(const Sample& exact, const Sample& near, int ptex, int corner, double diagonal) {
        ++count;
        const double distance = length(exact.position - near.position) / diagonal;
        if (!(distance <= largest_position)) {
            largest_position = distance;
            position_at[0] = ptex;
            position_at[1] = corner;
        }
        Vec3 exact_normal, near_normal;
        if (!normal_of(exact, diagonal, exact_normal) || !normal_of(near, diagonal, near_normal)) {
            ++degenerate_count;
            return;
        }
        ++normal_count;
        const double angle = angle_degrees(exact_normal, near_normal);
        if (!(angle <= largest_angle)) {
            largest_angle = angle;
            normal_at[0] = ptex;
            normal_at[1] = corner;
        }
    }

    std::string json() const {
        JsonObject object;
        object.count("n", count).number("max_pos", largest_position, "%.3g");
        object.json("pos_at", json_array(position_at, 2, "%.0f")).count("normals", normal_count);
        object.count("degenerate", degenerate_count).number("max_normal_deg", largest_angle, "%.3g");
        object.json("normal_at", json_array(normal_at, 2, "%.0f"));
        return object.str();
    }
};

// As the evaluator tells them apart.
CornerKind kind_of(const LimitOracle& oracle, const PtexFace& face, int corner) {
    try {
        ChainNode node(
            cut_out_one_ring(oracle.base_level(), oracle.cage().points.data(), face.base_face, 0, oracle.cage()));
        ChainNode& quad = node.is_regular_size() ? node : node.corner_quad(face.corner);
        return quad.corner_kind(corner);
    } catch (Pathological&) {
        return CornerKind::odd;
    }
}

} // namespace

void compare_corners(const LimitOracle& oracle) {
    const bool is_triangle = oracle.cage().is_loop();
    const double step = std::ldexp(1.0, -50);
    LimitEvaluator evaluator(oracle);
    CornerErrors errors[3];
    const Stopwatch stopwatch;
    for (int ptex = 0; ptex < oracle.ptex_count(); ++ptex) {
        const PtexFace& face = oracle.ptex_face(ptex);
        if (!face.has_limit)
            continue;
        for (int corner = 0; corner < corner_count(is_triangle); ++corner) {
            const auto [u, v] = corner_uv(corner, is_triangle);
            const auto [near_u, near_v] = step_inside(u, v, step, is_triangle);
            const Sample exact = evaluator.evaluate(ptex, u, v);
            const Sample near = evaluator.evaluate(ptex, near_u, near_v);
            CornerErrors& of_kind = errors[(int)kind_of(oracle, face, corner)];
            of_kind.add(exact, near, ptex, corner, oracle.extent().diagonal);
        }
    }
    JsonObject json;
    json.boolean("corners", true).json("smooth", errors[(int)CornerKind::smooth].json());
    json.json("sharp", errors[(int)CornerKind::sharp].json()).json("odd", errors[(int)CornerKind::odd].json());
    json.number("seconds", stopwatch.seconds(), "%.2f");
    printf("%s\n", json.str().c_str());
}

void probe(const LimitOracle& oracle, int ptex, int corner) {
    const bool is_triangle = oracle.cage().is_loop();
    LimitEvaluator evaluator(oracle);
    auto show = [&](const char* what, std::array<double, 2> uv) {
        const Sample sample = evaluator.evaluate(ptex, uv[0], uv[1]);
        Vec3 normal;
        const bool has_normal = normal_of(sample, oracle.extent().diagonal, normal);
        printf("%-12s P %.12g %.12g %.12g", what, sample.position.x, sample.position.y, sample.position.z);
        printf("  N %s %.9f %.9f %.9f", has_normal ? "ok" : "degenerate", normal.x, normal.y, normal.z);
        printf("  |Du| %.3g |Dv| %.3g", length(sample.tangent_u), length(sample.tangent_v));
        printf(" scale %.3g\n", sample.scale);
    };
    show("corner", corner_uv(corner, is_triangle));
    for (int direction = 0; direction < 3; ++direction)
        for (int exponent = 10; exponent <= 50; exponent += 10) {
            const double step = std::ldexp(1.0, -exponent);
            const double a = direction == 1 ? .25 * step : step, b = direction == 2 ? .25 * step : step;
            char what[32];
            snprintf(what, sizeof what, "dir%d 2^-%d", direction, exponent);
            show(what, into_domain(corner, a, b, is_triangle));
        }
}
