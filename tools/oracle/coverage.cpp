#include "coverage.h"

#include <algorithm>
#include <cmath>

namespace {

class CoverageCounter {
public:
    CoverageCounter(const LimitOracle& oracle, const Dump& dump)
        : oracle_(oracle), dump_(dump), areas_(oracle.ptex_count()), named_(oracle.ptex_count()) {}

    Coverage run() {
        for (int64_t face : dump_.face)
            if (exists(face))
                named_[face] = true;
        for (size_t i = 0; i + 2 < dump_.triangles.size(); i += 3)
            add_triangle(&dump_.triangles[i]);
        for (int ptex = 0; ptex < oracle_.ptex_count(); ++ptex)
            add_face(ptex);
        return coverage_;
    }

private:
    bool exists(int64_t face) const { return face >= 0 && face < oracle_.ptex_count(); }

    void add_triangle(const uint32_t* corners) {
        const uint32_t a = corners[0], b = corners[1], c = corners[2];
        if (std::max({a, b, c}) >= dump_.vertex_count()) {
            ++coverage_.bad_index_count;
            return;
        }
        const int64_t face = dump_.face[a];
        if (face != dump_.face[b] || face != dump_.face[c]) {
            ++coverage_.mixed_count;
            return;
        }
        if (!exists(face))
            return;
        const double u1 = (double)dump_.u[b] - dump_.u[a], v1 = (double)dump_.v[b] - dump_.v[a];
        const double u2 = (double)dump_.u[c] - dump_.u[a], v2 = (double)dump_.v[c] - dump_.v[a];
        const double area = .5 * (u1 * v2 - u2 * v1);
        coverage_.flipped_count += area < 0;
        coverage_.zero_count += area == 0;
        areas_[face] += std::fabs(area);
    }

    void add_face(int ptex) {
        if (!oracle_.ptex_face(ptex).has_limit) {
            ++coverage_.faces_without_limit;
            return;
        }
        if (!named_[ptex] && coverage_.uncovered_count++ == 0)
            coverage_.first_uncovered = ptex;
        const double domain_area = oracle_.cage().is_loop() ? .5 : 1;
        const double deviation = std::fabs(areas_[ptex] - domain_area);
        coverage_.off_count += deviation > 1e-5;
        if (deviation > coverage_.largest_deviation) {
            coverage_.largest_deviation = deviation;
            coverage_.worst_face = ptex;
        }
    }

    const LimitOracle& oracle_;
    const Dump& dump_;
    std::vector<double> areas_;
    std::vector<bool> named_;
    Coverage coverage_;
};

} // namespace

Coverage coverage_of(const LimitOracle& oracle, const Dump& dump) {
    return CoverageCounter(oracle, dump).run();
}
