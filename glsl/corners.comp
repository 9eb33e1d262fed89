#version 460
// One thread marks the limit points that the corners of one regular patch are drawn with.
#extension GL_GOOGLE_include_directive : require
#include "shared/marks.glsl"
layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform CornersPush {
    SceneTables scene;
    uint list; // LIST_BASE, whose entries are chunks, or LIST_PATCHES
} push;

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint place;
    if (push.list == LIST_BASE) {
        if (group >= push.scene.v.heads.v[LIST_BASE].count) {
            return;
        }
        ListItem chunk = push.scene.v.chunks.v[push.scene.v.chunk_first[3] + group];
        uint patch_index = chunk.place + gl_LocalInvocationID.x;
        if (patch_index >= push.scene.v.objects.v[chunk.object].patch_count) {
            return;
        }
        place = push.scene.v.objects.v[chunk.object].first_patch + patch_index;
    } else {
        uint thread = group * CHUNK + gl_LocalInvocationID.x;
        if (thread >= list_length(push.scene.v.heads, LIST_PATCHES)) {
            return;
        }
        place = push.scene.v.patch_items.v[thread].place;
    }
    uint seams = push.scene.v.patches.v[place].seams;
    if (seams == NONE) {
        return;
    }
    for (uint i = 0; i < 4; ++i) {
        mark_corner(push.scene, push.scene.v.seams.v[seams].limits[i]);
    }
}
