#version 460
// One thread makes one limit point of those in use: position and normal by limit masks (FAS section 4.1, Halstead et al. 1993).
#extension GL_GOOGLE_include_directive : require
#include "shared/scene.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

layout(push_constant, scalar) uniform Push {
    Points points;
    LimitPoints limits;
    StencilRows rows;
    Indices indices;
    LimitWeights weights; // of the position and of two tangents
    Indices in_use; // limit points
    ListHeads head; // their number
    LimitTangentTable tangents; // where surfaces are displaced, or have Gregory patches
} push;

void main()
{
    uint thread = thread_index();
    if (thread >= push.head.v[0].count) {
        return;
    }
    uint limit_index = push.in_use.v[thread];
    StencilRow row = push.rows.v[limit_index];
    precise vec3 origin = push.points.v[push.indices.v[row.first_index]];
    precise vec3 position = vec3(0.0);
    precise vec3 tangent0 = vec3(0.0);
    precise vec3 tangent1 = vec3(0.0);
    for (uint i = 1; i < row.count; ++i) {
        precise vec3 offset = push.points.v[push.indices.v[row.first_index + i]] - origin;
        vec3 weight = push.weights.v[row.first_weight + i];
        position = position + weight.x * offset;
        tangent0 = tangent0 + weight.y * offset;
        tangent1 = tangent1 + weight.z * offset;
    }
    vec3 normal = unit_normal(tangent0, tangent1);
    position = origin + position;
    LimitPoint result;
    result.position = position;
    result.normal = normal;
    push.limits.v[limit_index] = result;
    if (DISPLACED || GREGORY) {
        push.tangents.v[limit_index] = LimitTangents(tangent0, tangent1);
    }
}
