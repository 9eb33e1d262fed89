#include "normal_tolerance.h"

#include <algorithm>
#include <cmath>

NormalTolerance::NormalTolerance(const Cage& cage, double max_coordinate) : max_coordinate_(max_coordinate) {
    size_t first = 0;
    for (int size : cage.face_sizes) {
        double shortest = HUGE_VAL;
        for (int i = 0; i < size; ++i) {
            const Vec3& a = cage.points[cage.face_points[first + i]];
            const Vec3& b = cage.points[cage.face_points[first + (i + 1) % size]];
            shortest = std::min(shortest, length(b - a));
        }
        shortest_edges_.push_back(shortest);
        first += size;
    }
}

double NormalTolerance::degrees(int base_face, int level) const {
    const double least = .01;
    const double rounding = 4 * std::ldexp(max_coordinate_, -24);
    const double edge = std::ldexp(shortest_edges_[base_face], -level);
    return std::max(least, rounding / edge * (180 / M_PI));
}
