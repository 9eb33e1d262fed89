#version 460
// Hands on the faces that are evaluated by table to their draw list: one thread a face.
#extension GL_GOOGLE_include_directive : require
#include "shared/append.glsl"
#include "shared/table_factors.glsl"
layout(local_size_x = 64) in;

// Vertices that one draw should generate on a software driver; 0: all patches are one draw.
layout(constant_id = 1) const uint BATCH_VERTICES = 0;
// Whether frames may cull at all: without it the tests are not even compiled.
layout(constant_id = 2) const bool CULL = true;

layout(push_constant, scalar) uniform EmitPush {
    SceneTables scene;
    uint list; // LIST_BASE
} push;

#include "shared/draw_lists.glsl"

shared uint patch_count;

// Whether all points that a face is made of lie outside of one plane of the view: it lies between them, where weights are not negative.
bool is_table_patch_outside(Object object, TablePatch face, EmitView view)
{
    uint planes = 31u;
    for (uint i = 0u; i < face.control_count; ++i) {
        vec3 point = push.scene.v.points.v[push.scene.v.table_controls.v[face.first_control + i]];
        planes &= point_outside_planes(to_world(object, point), view, object.displacement);
    }
    return planes != 0u;
}

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (gl_LocalInvocationID.x == 0u) {
        patch_count = 0u;
    }
    barrier();
    bool is_seen = group < push.scene.v.heads.v[LIST_BASE].count;
    ListItem item = ListItem(0u, 0u);
    if (is_seen) {
        item = push.scene.v.chunks.v[push.scene.v.chunk_first[3] + group];
        Object object = push.scene.v.objects.v[item.object];
        uint place = item.place + gl_LocalInvocationID.x;
        item.place = object.first_patch + place;
        is_seen = place < object.patch_count;
    }
    DrawEntry entry;
    uint segments = 1u;
    if (is_seen) {
        Object object = push.scene.v.objects.v[item.object];
        FrameInput frame = push.scene.v.frame_input.v;
        TablePatch face = push.scene.v.table_patches.v[item.place];
        FaceDensity density = face_density(push.scene, object, face.ptex_face);
        vec4 factors = table_factors(density, face.flags, face.corner_uvs, push.scene.v.table_steps, push.scene.v.table_level);
        segments = table_segments(largest_factor(factors));
        // Of a triangle too: half of them have no area.
        uint triangles = 2u * segments * segments;
        entry = DrawEntry(item.place, item.object, segments, triangles, factors, vec4(0.0), vec2(0.0));
        if (is_culled(frame) && (object.flags & OBJECT_IN_HULL) != 0u) {
            is_seen = !is_table_patch_outside(object, face, frame.view);
        }
        if (is_seen) {
            atomicAdd(patch_count, 1u);
        }
    }
    append_entries(DRAW_TABLE, is_seen, entry, (segments + 1u) * (segments + 1u));
    barrier();
    if (gl_LocalInvocationID.x == 0u && patch_count != 0u) {
        atomicAdd(push.scene.v.counts.v.table[push.scene.v.table_steps], patch_count);
    }
}
