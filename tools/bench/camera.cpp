#include "camera.h"

#include <algorithm>
#include <cmath>

static void set_view(Camera& camera, const double eye[3], const double forward[3]) {
    // side = forward x (0, 1, 0), up = side x forward
    double side[3] = {-forward[2], 0, forward[0]};
    const double norm = std::sqrt(side[0] * side[0] + side[2] * side[2]);
    side[0] /= norm;
    side[2] /= norm;
    const double up[3] = {side[1] * forward[2] - side[2] * forward[1], side[2] * forward[0] - side[0] * forward[2],
                          side[0] * forward[1] - side[1] * forward[0]};
    const double back[3] = {-forward[0], -forward[1], -forward[2]};
    const double* rows[3] = {side, up, back};
    for (int row = 0; row < 3; ++row) {
        double translation = 0;
        for (int k = 0; k < 3; ++k) {
            camera.view[4 * k + row] = (float)rows[row][k];
            translation -= rows[row][k] * eye[k];
        }
        camera.view[12 + row] = (float)translation;
    }
    camera.view[15] = 1;
}

static void set_projection(Camera& camera, double aspect) {
    const double near = .05 * camera.diagonal, far = 4 * camera.diagonal;
    const double focal = 1 / std::tan(22.5 * M_PI / 180); // half of 45 degrees
    camera.projection[0] = (float)(focal / aspect);
    camera.projection[5] = (float)focal;
    camera.projection[10] = (float)((far + near) / (near - far));
    camera.projection[11] = -1;
    camera.projection[14] = (float)(2 * far * near / (near - far));
}

Camera default_camera(const std::vector<float>& points, double aspect) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < points.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], (double)points[i]);
        high[i % 3] = std::max(high[i % 3], (double)points[i]);
    }
    Camera camera;
    double square = 0;
    for (int k = 0; k < 3; ++k)
        square += (high[k] - low[k]) * (high[k] - low[k]);
    camera.diagonal = std::sqrt(square);

    const double direction[3] = {1, .6, 1.2}, norm = std::sqrt(1 + .36 + 1.44);
    double eye[3], forward[3];
    for (int k = 0; k < 3; ++k) {
        eye[k] = .5 * (low[k] + high[k]) + camera.diagonal * 1.1 * direction[k] / norm;
        forward[k] = -direction[k] / norm;
    }
    set_view(camera, eye, forward);
    set_projection(camera, aspect);
    return camera;
}
