#version 460
// One thread makes what one limit point in use gives to the patches around it, by ACC or for Pm-patches: for each edge there the points
// and vectors that four rows are of. CPU twin: crates/render/src/rival_spokes.rs.
#extension GL_GOOGLE_include_directive : require
#include "shared/scene.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

layout(push_constant, scalar) uniform Push {
    Points points;
    LimitPoints limits;
    SpokeRanges ranges; // first spoke and number of spokes of each limit point
    RivalSpokes spokes;
    Indices indices;
    Weights weights;
    SpokePoints made;
    Points made_middles;
    Indices in_use; // limit points
    ListHeads head; // their number
} push;

precise vec3 origin_of(StencilRow row)
{
    return push.points.v[push.indices.v[row.first_index]];
}

precise vec3 weighed(StencilRow row)
{
    vec3 origin = origin_of(row);
    precise vec3 sum = vec3(0.0);
    for (uint j = 1; j < row.count; ++j) {
        precise vec3 offset = push.points.v[push.indices.v[row.first_index + j]] - origin;
        sum = sum + push.weights.v[row.first_weight + j] * offset;
    }
    return sum;
}

void main()
{
    uint thread = thread_index();
    if (thread >= push.head.v[0].count) {
        return;
    }
    uint limit_index = push.in_use.v[thread];
    vec3 limit = push.limits.v[limit_index].position;
    uvec2 range = push.ranges.v[limit_index];
    for (uint i = range.x; i < range.x + range.y; ++i) {
        RivalSpoke spoke = push.spokes.v[i];
        precise vec3 edge = limit + weighed(spoke.edge);
        precise vec3 middle = origin_of(spoke.middle) + weighed(spoke.middle);
        push.made.v[i] = SpokePoint(edge, weighed(spoke.across), weighed(spoke.beside));
        push.made_middles.v[i] = middle;
    }
}
