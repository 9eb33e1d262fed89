#version 460
// variants: rings=RINGS stencils=STENCILS limits=LIMITS
// Normals of the points of a level: of a vertex' ring (RINGS), or weighed as the points are and made unit vectors (STENCILS; LIMITS those
// of limit points): Subdivision Shading (Alexa and Boubekeur 2008).
#extension GL_GOOGLE_include_directive : require
#include "shared/scene.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

// An open ring: nothing lies between its last vertex and its first.
const uint OPEN_RING = 0x80000000u;

layout(push_constant, scalar) uniform TableNormalsPush {
    Points points;
    Points normals;
    LimitPoints limits;
    StencilRows rows;
    Indices indices;      // of rings, stencils or limit rows
    Weights weights;
    LimitWeights limit_weights;
    uint first_row;
    uint count;
    uint first_point;     // the place of row 0's point
    uint is_first_alone;  // limit points have the normal of their own vertex
} push;

#if defined(RINGS)
vec3 ring_normal(uint place, StencilRow row)
{
    uint count = row.count & ~OPEN_RING;
    precise vec3 origin = push.points.v[place];
    precise vec3 sum = vec3(0.0);
    uint last = (row.count & OPEN_RING) != 0u ? count - 1u : count;
    for (uint i = 0u; i < last; ++i) {
        uint next = i + 1u == count ? 0u : i + 1u;
        precise vec3 a = push.points.v[push.indices.v[row.first_index + i]] - origin;
        precise vec3 b = push.points.v[push.indices.v[row.first_index + next]] - origin;
        sum = sum + precise_cross(a, b);
    }
    return unit_vector(sum);
}
#endif

void main()
{
    uint thread = thread_index();
    if (thread >= push.count) {
        return;
    }
    uint row_index = push.first_row + thread;
    StencilRow row = push.rows.v[row_index];
#if defined(RINGS)
    uint place = push.first_point + thread;
    push.normals.v[place] = row.count == 0u ? vec3(0.0) : ring_normal(place, row);
#else
    precise vec3 sum = vec3(0.0);
    uint count = push.is_first_alone != 0u ? 1u : row.count;
    for (uint i = 0u; i < count; ++i) {
        vec3 normal = push.normals.v[push.indices.v[row.first_index + i]];
#if defined(LIMITS)
        sum = sum + (push.is_first_alone != 0u ? 1.0 : push.limit_weights.v[row.first_weight + i].x) * normal;
#else
        sum = sum + push.weights.v[row.first_weight + i] * normal;
#endif
    }
#if defined(LIMITS)
    push.limits.v[row_index].normal = unit_vector(sum);
#else
    push.normals.v[push.first_point + row_index] = unit_vector(sum);
#endif
#endif
}
