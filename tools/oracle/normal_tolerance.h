#pragma once

#include "../osd/cage.h"

#include <vector>

// How far a normal computed in float may be off.
//
// Float rounds a coordinate of magnitude M by up to M * 2^-24. Over an edge of length e that turns the plane through
// its ends by about M * 2^-24 / e, and four such roundings meet in a cross product of differences. e is the shortest
// edge of the base face after the subdivisions that the patch had. Below 0.01 degrees nothing is asked for.
class NormalTolerance {
public:
    NormalTolerance(const Cage& cage, double max_coordinate);

    double degrees(int base_face, int level) const;

private:
    double max_coordinate_;
    std::vector<double> shortest_edges_;
};
