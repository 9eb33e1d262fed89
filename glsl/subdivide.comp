#version 460
// One thread makes one point of a level from points of the levels before (FAS section 3.2), of those in use.
#extension GL_GOOGLE_include_directive : require
#include "shared/scene.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

layout(push_constant, scalar) uniform Push {
    Points points;
    StencilRows rows;
    Indices indices;
    Weights weights;
    Indices in_use;   // rows
    ListHeads head;   // their number
    uint first_point; // the place of row 0's point
} push;

void main()
{
    uint thread = thread_index();
    if (thread >= push.head.v[0].count) {
        return;
    }
    uint row_index = push.in_use.v[thread];
    StencilRow row = push.rows.v[row_index];
    // Relative to the row's origin: differences of neighbours keep their digits.
    precise vec3 origin = push.points.v[push.indices.v[row.first_index]];
    precise vec3 sum = vec3(0.0);
    for (uint i = 1; i < row.count; ++i) {
        precise vec3 offset = push.points.v[push.indices.v[row.first_index + i]] - origin;
        sum = sum + push.weights.v[row.first_weight + i] * offset;
    }
    precise vec3 result = origin + sum;
    push.points.v[push.first_point + row_index] = result;
}
