// Whether nothing can be seen of a patch-filling quad. CPU twin: crates/render/src/visibility.rs.
#ifndef PLANISH_QUAD_VISIBILITY
#define PLANISH_QUAD_VISIBILITY
#include "visibility.glsl"

// Whether a triangle shows its back, by offsets of its corners from the eye.
bool is_triangle_turned(vec3 d0, vec3 d1, vec3 d2, float error, float eye_rounding)
{
    precise vec3 a = d1 - d0;
    precise vec3 b = d2 - d0;
    precise float a_length = sqrt(precise_dot(a, a));
    precise float b_length = sqrt(precise_dot(b, b));
    precise float area = a_length * b_length;
    precise float noise = TURN_MARGIN * area + (2.0 * error) * ((a_length + b_length) + 2.0 * error);
    precise float least = sqrt(precise_dot(d0, d0)) * noise + (2.0 * eye_rounding) * area;
    return precise_dot(d0, precise_cross(a, b)) > least;
}

// Whether all triangles of a flat quad show their back, split along either diagonal.
bool is_quad_turned(vec3 d0, vec3 d1, vec3 d2, vec3 d3, float error, float eye_rounding)
{
    return is_triangle_turned(d0, d1, d2, error, eye_rounding) && is_triangle_turned(d0, d2, d3, error, eye_rounding)
        && is_triangle_turned(d0, d1, d3, error, eye_rounding) && is_triangle_turned(d1, d2, d3, error, eye_rounding);
}

// Whether nothing can be seen of the triangles of a quad, of which 8 points are given: corners, and the middles of split edges.
bool is_quad_unseen(vec3 p[8], uint split_edges, EmitView view, bool cull_back, float displacement)
{
    float largest_offset = 0.0;
    float largest = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        precise vec3 offset = p[i] - view.eye;
        largest_offset = max(largest_offset, largest_component(offset));
        largest = max(largest, largest_component(p[i]));
    }
    Scale scale = scale_of(view, 1.0, largest_offset, largest);
    precise float margin = displacement * scale.factor;
    uint planes = 31u;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        precise vec3 offset = p[i] * scale.factor - scale.eye;
        p[i] = offset;
        planes &= outside_planes(offset, view, scale, margin);
    }
    precise float error = scale.rounding + CUBE_DIAGONAL * view.snap;
    if (!cull_back || displacement != 0.0) {
        return planes != 0u;
    }
    if (split_edges == 0u) {
        return planes != 0u || is_quad_turned(p[0], p[1], p[2], p[3], error, scale.eye_rounding);
    }
    // The fan's triangles. Middles that are not there lie at a corner: their triangles have no area, and show neither side.
    uint fan = uint(findLSB(split_edges));
    bool is_turned = true;
    for (uint i = 0; i < 4; ++i) {
        uint next = (i + 1u) & 3u;
        bool is_there = (split_edges >> i & 1u) != 0u;
        if (i == fan) {
            continue;
        }
        if (is_there) {
            is_turned = is_turned && is_triangle_turned(p[4u + fan], p[i], p[4u + i], error, scale.eye_rounding)
                && is_triangle_turned(p[4u + fan], p[4u + i], p[next], error, scale.eye_rounding);
        } else {
            is_turned = is_turned && is_triangle_turned(p[4u + fan], p[i], p[next], error, scale.eye_rounding);
        }
    }
    return planes != 0u || is_turned;
}
#endif
