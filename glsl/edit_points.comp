#version 460
// One thread applies the hierarchical edits of one point (FAS section 6.3), after its level was made and before the next.
#extension GL_GOOGLE_include_directive : require
#include "shared/tables.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

layout(push_constant, scalar) uniform EditPush {
    Points points;
    EditTargets targets;
    Points offsets;
    uint first_edit;
    uint edit_count;
} push;

void main()
{
    uint thread = thread_index();
    if (thread >= push.edit_count) {
        return;
    }
    uint edit = push.first_edit + thread;
    EditTarget target = push.targets.v[edit];
    vec3 kept = target.keeps != 0u ? push.points.v[target.point] : vec3(0.0);
    precise vec3 result = kept + push.offsets.v[edit];
    push.points.v[target.point] = result;
}
