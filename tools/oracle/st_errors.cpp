#include "st_errors.h"

#include "one_ring.h"
#include "st_oracle.h"

#include <algorithm>
#include <cmath>
#include <thread>

void StErrors::merge(const StErrors& other) {
    worst.take(other.worst.error, other.worst.vertex, other.worst.expected);
    sum += other.sum;
    count += other.count;
    nonfinite_count += other.nonfinite_count;
    pathological_count += other.pathological_count;
}

static void add(StErrors& errors, ValueEvaluator& evaluator, const Dump& dump, uint32_t vertex, double largest) {
    const double s = dump.s[vertex], t = dump.t[vertex];
    if (!std::isfinite(s + t)) {
        ++errors.nonfinite_count;
        return;
    }
    const double u = std::clamp<double>(dump.u[vertex], 0, 1), v = std::clamp<double>(dump.v[vertex], 0, 1);
    try {
        const Vec3 expected = evaluator.evaluate((int)dump.face[vertex], u, v);
        const double error = std::hypot(s - expected.x, t - expected.y) / largest;
        errors.worst.take(error, vertex, expected);
        errors.sum += error;
        ++errors.count;
    } catch (Pathological&) {
        ++errors.pathological_count;
    }
}

StErrors compare_st(const LimitOracle& oracle, const Dump& dump, const std::vector<uint32_t>& vertices) {
    double largest = 0;
    for (int value : oracle.cage().face_values)
        largest =
            std::max({largest, std::fabs(oracle.cage().values[value].x), std::fabs(oracle.cage().values[value].y)});
    if (!(largest > 0))
        largest = 1;
    auto is_semi_sharp = [](float sharpness) {
        return sharpness > 0 && sharpness < infinite_sharpness;
    };
    const Cage& cage = oracle.cage();
    const bool has_semi_sharp =
        std::any_of(cage.crease_sharpness.begin(), cage.crease_sharpness.end(), is_semi_sharp) ||
        std::any_of(cage.corner_sharpness.begin(), cage.corner_sharpness.end(), is_semi_sharp);
    // Holes are not refined, and Chaikin's rule beside them would not see all edges; without them all else is the same.
    Cage whole = cage;
    whole.hole_faces.clear();
    if (cage.options.GetVtxBoundaryInterpolation() == OpenSubdiv::Sdc::Options::VTX_BOUNDARY_NONE)
        whole.options.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    const auto refined = std::make_shared<RefinedValues>(std::move(whole), has_semi_sharp);
    const size_t thread_count = (size_t)oracle.options().thread_count;
    std::vector<StErrors> errors(thread_count);
    std::vector<std::thread> threads;
    for (size_t t = 0; t < thread_count; ++t)
        threads.emplace_back([&, t] {
            ValueEvaluator evaluator(oracle, refined);
            const size_t first = vertices.size() * t / thread_count, last = vertices.size() * (t + 1) / thread_count;
            for (size_t k = first; k < last; ++k)
                if (oracle.ptex_face((int)dump.face[vertices[k]]).has_limit)
                    add(errors[t], evaluator, dump, vertices[k], largest);
        });
    StErrors total;
    for (size_t t = 0; t < thread_count; ++t) {
        threads[t].join();
        total.merge(errors[t]);
    }
    return total;
}
