#version 460
// One thread marks what one irregular leaf is drawn with: the limits of its corners, and of the middles of its edges where the
// neighbour is refined; or the limit points that its Gregory patch is made of.
#extension GL_GOOGLE_include_directive : require
#include "shared/marks.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

layout(push_constant, scalar) uniform Push {
    SceneTables scene;
} push;

void main()
{
    uint thread = thread_index();
    if (thread >= list_length(push.scene.v.heads, LIST_LEAVES)) {
        return;
    }
    ListItem item = push.scene.v.leaf_items.v[thread];
    if (GREGORY && gregory_kind(push.scene.v.gregory.v[item.place].flags) != GREGORY_NONE) {
        for (uint i = 0; i < 4; ++i) {
            mark_corner(push.scene, push.scene.v.gregory.v[item.place].limits[i]);
            if ((push.scene.v.irregular.v[item.place].flags >> (FACE_STAR_LIMITS_SHIFT + i) & 1u) != 0u) {
                mark_star(push.scene, push.scene.v.irregular.v[item.place].stars[i]);
            }
        }
        return;
    }
    uint first_edge = push.scene.v.objects.v[item.object].first_edge;
    for (uint i = 0; i < 4; ++i) {
        mark_corner(push.scene, push.scene.v.irregular.v[item.place].limits[i]);
        if ((push.scene.v.irregular.v[item.place].flags >> (FACE_STAR_LIMITS_SHIFT + i) & 1u) != 0u) {
            mark_star(push.scene, push.scene.v.irregular.v[item.place].stars[i]);
        }
        uint edge = push.scene.v.irregular.v[item.place].edges[i];
        if (edge == NONE) {
            continue;
        }
        uint bit = first_edge + edge;
        if ((push.scene.v.split_edges.v[bit >> 5] >> (bit & 31u) & 1u) != 0u) {
            mark_corner(push.scene, push.scene.v.irregular.v[item.place].midpoints[i]);
            mark_star(push.scene, push.scene.v.irregular.v[item.place].stars[i]);
            mark_star(push.scene, push.scene.v.irregular.v[item.place].stars[(i + 1u) & 3u]);
        }
    }
}
