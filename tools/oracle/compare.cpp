#include "commands.h"
#include "coverage.h"
#include "dump.h"
#include "st_errors.h"
#include "vertex_errors.h"

#include "../shared/json.h"
#include "../shared/stopwatch.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <thread>

namespace {

// The vertices that name a face that there is, those of one base face side by side.
struct VertexOrder {
    std::vector<uint32_t> vertices;
    // Where in `vertices` each base face begins, and their end.
    std::vector<size_t> begins;
    size_t bad_face_count = 0;
};

VertexOrder order_by_base_face(const LimitOracle& oracle, const Dump& dump) {
    VertexOrder order;
    for (size_t i = 0; i < dump.vertex_count(); ++i) {
        if (dump.face[i] < 0 || dump.face[i] >= oracle.ptex_count())
            ++order.bad_face_count;
        else
            order.vertices.push_back((uint32_t)i);
    }
    std::stable_sort(order.vertices.begin(), order.vertices.end(), [&](uint32_t a, uint32_t b) {
        return dump.face[a] < dump.face[b];
    });
    int previous = -1;
    for (size_t k = 0; k < order.vertices.size(); ++k) {
        const int base_face = oracle.ptex_face((int)dump.face[order.vertices[k]]).base_face;
        if (base_face != previous)
            order.begins.push_back(k);
        previous = base_face;
    }
    order.begins.push_back(order.vertices.size());
    return order;
}

VertexErrors compare_vertices(const LimitOracle& oracle, const Dump& dump, const VertexOrder& order) {
    const NormalTolerance tolerance(oracle.cage(), oracle.extent().max_coordinate);
    const size_t face_count = order.begins.size() - 1, block_size = 8;
    const int thread_count = oracle.options().thread_count;
    std::atomic<size_t> next_face(0);
    std::vector<VertexErrors> errors(thread_count);
    std::vector<std::thread> threads;
    for (int t = 0; t < thread_count; ++t)
        threads.emplace_back([&, t] {
            VertexComparer comparer(oracle, dump, tolerance);
            for (;;) {
                const size_t first = next_face.fetch_add(block_size);
                if (first >= face_count)
                    break;
                const size_t last = std::min(first + block_size, face_count);
                for (size_t k = order.begins[first]; k < order.begins[last]; ++k)
                    comparer.add(order.vertices[k]);
            }
            errors[t] = comparer.errors();
        });
    VertexErrors total;
    total.bad_domain_count = order.bad_face_count;
    for (int t = 0; t < thread_count; ++t) {
        threads[t].join();
        total.merge(errors[t]);
    }
    return total;
}

std::string json_of(const WorstVertex& worst, const Dump& dump, Vec3 got) {
    if (worst.error < 0)
        return "null";
    const size_t i = worst.vertex;
    JsonObject json;
    json.count("vertex", i).integer("face", dump.face[i]);
    json.number("u", dump.u[i], "%.9g").number("v", dump.v[i], "%.9g");
    json.json("got", json_array(&got.x, 3, "%.9g"));
    json.json("oracle", json_array(&worst.expected.x, 3, "%.12g"));
    return json.str();
}

void add_errors(JsonObject& json, const VertexErrors& errors, const CageExtent& extent) {
    auto rms = [](double square_sum, size_t count) {
        return std::sqrt(square_sum / std::max<size_t>(1, count));
    };
    const double largest = std::max(0.0, errors.position.error);
    const double per_coordinate = extent.diagonal / extent.max_coordinate;
    json.number("max_pos_err", largest);
    json.number("rms_pos_err", rms(errors.position_square_sum, errors.position_count));
    json.number("max_pos_err_ordinary", errors.largest_ordinary_position);
    json.number("max_pos_err_rel", largest * per_coordinate);
    json.number("max_pos_err_rel_ordinary", errors.largest_ordinary_position * per_coordinate);
    json.number("max_normal_deg", std::max(0.0, errors.normal.error));
    json.number("rms_normal_deg", rms(errors.normal_square_sum, errors.normal_count));
    json.count("normals_compared", errors.normal_count);
    json.count("normal_tolerance_exceeded", errors.tolerance_exceeded_count);
    json.number("worst_normal_ratio", errors.largest_normal_ratio);
    json.count("normals_over_90deg", errors.normals_over_90_count);
    json.count("oracle_normal_degenerate", errors.oracle_degenerate_count);
    json.count("dump_normal_bad", errors.dump_normal_bad_count);
    json.count("nonfinite_positions", errors.nonfinite_count);
    json.count("bad_face_or_uv", errors.bad_domain_count);
    json.count("on_faces_without_limit", errors.without_limit_count);
    json.count("pathological_faces", errors.pathological_count);

    JsonObject special;
    special.count("sharp_irregular", errors.kind_counts[(int)PointKind::sharp_irregular]);
    special.count("odd", errors.kind_counts[(int)PointKind::odd]);
    special.count("normal_ambiguous", errors.ambiguous_count);
    special.number("max_deg_vs_mask", errors.special_vs_mask);
    special.number("max_deg_vs_diagonal_limit", errors.special_vs_diagonal);
    special.number("max_deg_vs_nearest", errors.special_vs_nearest);
    json.json("special_corners", special.str());
}

// Where the dump has s and t and the cage has values.
void add_st_errors(JsonObject& json, const LimitOracle& oracle, const Dump& dump, const VertexOrder& order) {
    if (dump.s.empty() || oracle.cage().face_values.empty())
        return;
    const StErrors errors = compare_st(oracle, dump, order.vertices);
    json.count("st_compared", errors.count);
    json.number("max_st_err", std::max(0.0, errors.worst.error));
    json.number("mean_st_err", errors.mean());
    json.count("nonfinite_st", errors.nonfinite_count);
    json.count("pathological_st", errors.pathological_count);
    const size_t i = errors.worst.vertex;
    const Vec3 got = errors.count ? Vec3{dump.s[i], dump.t[i], 0} : Vec3();
    json.json("worst_st", json_of(errors.worst, dump, got));
}

void add_coverage(JsonObject& json, const Coverage& coverage) {
    json.count("ptex_faces_without_limit", coverage.faces_without_limit);
    json.count("ptex_faces_uncovered", coverage.uncovered_count);
    json.integer("first_uncovered", coverage.first_uncovered);
    json.number("uv_area_max_dev", coverage.largest_deviation);
    json.integer("uv_area_worst_face", coverage.worst_face);
    json.count("uv_area_faces_off", coverage.off_count);
    json.count("uv_flipped_triangles", coverage.flipped_count);
    json.count("uv_zero_triangles", coverage.zero_count);
    json.count("mixed_face_triangles", coverage.mixed_count);
    json.count("bad_index_triangles", coverage.bad_index_count);
}

} // namespace

void compare(const LimitOracle& oracle, const std::string& dump_path) {
    const Stopwatch stopwatch;
    const Dump dump = read_dump(dump_path);
    const VertexOrder order = order_by_base_face(oracle, dump);
    const VertexErrors errors = compare_vertices(oracle, dump, order);
    const Coverage coverage = coverage_of(oracle, dump);

    JsonObject json;
    json.count("vertices", dump.vertex_count()).count("compared", errors.position_count);
    json.count("triangles", dump.triangles.size() / 3).integer("ptex_faces", oracle.ptex_count());
    json.number("bbox_diag", oracle.extent().diagonal, "%.9g");
    json.number("max_coordinate", oracle.extent().max_coordinate, "%.9g");
    add_errors(json, errors, oracle.extent());
    add_coverage(json, coverage);
    const bool has_vertices = dump.vertex_count() > 0;
    const Vec3 got_position = has_vertices ? dump.position(errors.position.vertex) : Vec3();
    const Vec3 got_normal = has_vertices ? dump.normal(errors.normal.vertex) : Vec3();
    json.json("worst_pos", json_of(errors.position, dump, got_position));
    json.json("worst_normal", json_of(errors.normal, dump, got_normal));
    add_st_errors(json, oracle, dump, order);
    json.number("seconds", stopwatch.seconds(), "%.2f");
    printf("%s\n", json.str().c_str());
}

void compare_st_alone(const LimitOracle& oracle, const std::string& dump_path) {
    const Stopwatch stopwatch;
    const Dump dump = read_dump(dump_path);
    JsonObject json;
    json.count("vertices", dump.vertex_count());
    add_st_errors(json, oracle, dump, order_by_base_face(oracle, dump));
    json.number("seconds", stopwatch.seconds(), "%.2f");
    printf("%s\n", json.str().c_str());
}
