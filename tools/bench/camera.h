#pragma once

#include <vector>

// The default view; README.md has its formulas.
struct Camera {
    // Column by column, as GL takes them.
    float view[16] = {};
    float projection[16] = {};
    // Of the box of the points.
    double diagonal = 0;
};

// `points` are x y z one after another.
Camera default_camera(const std::vector<float>& points, double aspect);
