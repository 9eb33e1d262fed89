#version 460
// One thread makes what one limit point in use gives to the Gregory patches around it (Loop et al. 2009, sections 3.3 and 3.4): for
// each edge there the edge point and the two vectors beside it. The vertex stage of the paper's section 4.1. CPU twin:
// crates/render/src/spokes.rs.
#extension GL_GOOGLE_include_directive : require
#include "shared/scene.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

layout(push_constant, scalar) uniform Push {
    Points points;
    LimitPoints limits;
    LimitTangentTable tangents;
    SpokeRanges ranges; // first spoke and number of spokes of each limit point
    Spokes spokes;
    Indices indices;
    Weights weights;
    SpokePoints made;
    Indices in_use; // limit points
    ListHeads head; // their number
} push;

precise vec3 edge_point(uint spoke, LimitPoint limit, LimitTangents tangents)
{
    precise vec3 along = push.spokes.v[spoke].along.x * tangents.a + push.spokes.v[spoke].along.y * tangents.b;
    precise vec3 to_end = push.points.v[push.spokes.v[spoke].end] - limit.position;
    float out_of_plane = push.spokes.v[spoke].is_projected != 0u ? precise_dot(limit.normal, to_end) : 0.0;
    precise vec3 in_plane = to_end - limit.normal * out_of_plane;
    precise vec3 result = limit.position + (along + push.spokes.v[spoke].direct * in_plane);
    return result;
}

precise vec3 between(vec3 before, vec3 after)
{
    precise vec3 result = 1.5 * (after - before);
    return result;
}

void main()
{
    uint thread = thread_index();
    if (thread >= push.head.v[0].count) {
        return;
    }
    uint limit_index = push.in_use.v[thread];
    LimitPoint limit = push.limits.v[limit_index];
    LimitTangents tangents = push.tangents.v[limit_index];
    uvec2 range = push.ranges.v[limit_index];
    for (uint i = range.x; i < range.x + range.y; ++i) {
        SpokePoint made;
        made.edge = edge_point(i, limit, tangents);
        made.across = vec3(0.0);
        uint before = push.spokes.v[i].before;
        uint after = push.spokes.v[i].after;
        if (before != NONE && after != NONE) {
            made.across = between(edge_point(before, limit, tangents), edge_point(after, limit, tangents));
        }
        StencilRow row = push.spokes.v[i].row;
        precise vec3 origin = push.points.v[push.indices.v[row.first_index]];
        precise vec3 beside = vec3(0.0);
        for (uint j = 1; j < row.count; ++j) {
            precise vec3 offset = push.points.v[push.indices.v[row.first_index + j]] - origin;
            beside = beside + push.weights.v[row.first_weight + j] * offset;
        }
        made.beside = beside;
        push.made.v[i] = made;
    }
}
