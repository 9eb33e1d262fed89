#version 460
// One group decides of one object whether any of it may be seen, and lists its vertices and faces in chunks.
#extension GL_GOOGLE_include_directive : require
#include "shared/append.glsl"
layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    SceneTables scene;
} push;

shared uint first_chunk[4];
shared uint chunk_counts[4];
shared vec3 lows[gl_WorkGroupSize.x];
shared vec3 highs[gl_WorkGroupSize.x];
shared float longest[gl_WorkGroupSize.x];

// Length in the world of the longest edge at a vertex.
float longest_edge(Object object, uint vertex)
{
    uint slot = object.first_mesh_slot + vertex;
    vec3 a = to_world(object, push.scene.v.points.v[object.first_point + vertex]);
    float square = 0.0;
    for (uint i = push.scene.v.neighbour_first.v[slot]; i < push.scene.v.neighbour_first.v[slot + 1]; ++i) {
        vec3 b = to_world(object, push.scene.v.points.v[object.first_point + push.scene.v.neighbours.v[i]]);
        precise vec3 edge = b - a;
        square = max(square, precise_dot(edge, edge));
    }
    return sqrt(square);
}

// The box around a cage that deforms and its longest edge, by all threads of the group. The edge is only asked for where objects
// have one density.
void measure_cage(inout Object object, bool wants_edge)
{
    uint thread = gl_LocalInvocationID.x;
    vec3 low = push.scene.v.points.v[object.first_point];
    vec3 high = low;
    float edge = 0.0;
    for (uint i = thread; i < object.vertex_count; i += gl_WorkGroupSize.x) {
        vec3 p = push.scene.v.points.v[object.first_point + i];
        low = min(low, p);
        high = max(high, p);
        if (wants_edge) {
            edge = max(edge, longest_edge(object, i));
        }
    }
    lows[thread] = low;
    highs[thread] = high;
    longest[thread] = edge;
    barrier();
    for (uint i = 0; i < gl_WorkGroupSize.x; ++i) {
        low = min(low, lows[i]);
        high = max(high, highs[i]);
        edge = max(edge, longest[i]);
    }
    object.low = low;
    object.high = high;
    object.largest_edge = edge;
}

// Whether the box around an object lies outside of one plane of the view.
bool is_outside(Object object, EmitView view)
{
    uint planes = 31u;
    for (uint corner = 0; corner < 8; ++corner) {
        bvec3 is_high = bvec3((corner & 1u) != 0u, (corner & 2u) != 0u, (corner & 4u) != 0u);
        planes &= point_outside_planes(to_world(object, mix(object.low, object.high, is_high)), view, object.displacement);
    }
    return planes != 0u;
}

void main()
{
    uint index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    FrameInput frame = push.scene.v.frame_input.v;
    if (index >= frame.object_count) {
        return;
    }
    Object object = push.scene.v.objects.v[index];
    if ((object.flags & OBJECT_DEFORMS) != 0u) {
        measure_cage(object, frame.object_lod != 0u);
        if (gl_LocalInvocationID.x == 0u) {
            push.scene.v.objects.v[index].low = object.low;
            push.scene.v.objects.v[index].high = object.high;
            push.scene.v.objects.v[index].largest_edge = object.largest_edge;
        }
    }
    uint counts[4] = uint[4](object.vertex_count, object.slot_count - object.vertex_count, object.root_count, object.patch_count);
    if (gl_LocalInvocationID.x < 4u) {
        uint kind = gl_LocalInvocationID.x;
        bool is_culled = frame.view.cull != 0u && (object.flags & OBJECT_IN_HULL) != 0u && is_outside(object, frame.view);
        // The static selection asks for the largest density of all, seen or not.
        bool is_needed = !is_culled || (kind <= LIST_MIDDLES && frame.selection == SELECT_STATIC);
        is_needed = is_needed && (object.flags & OBJECT_HIDDEN) == 0u;
        uint count = is_needed ? (counts[kind] + CHUNK - 1u) / CHUNK : 0u;
        ListHeads heads = push.scene.v.heads;
        uint list = kind;
        uint first = count == 0u ? 0u : atomicAdd(heads.v[list].count, count);
        // A chunk is a group.
        if (count != 0u) {
            atomicMax(heads.v[list].groups_x, min(first + count, 65535u));
            atomicMax(heads.v[list].groups_y, (first + count + 65534u) / 65535u);
        }
        first_chunk[kind] = push.scene.v.chunk_first[kind] + first;
        chunk_counts[kind] = count;
    }
    barrier();
    for (uint kind = 0; kind < 4; ++kind) {
        for (uint i = gl_LocalInvocationID.x; i < chunk_counts[kind]; i += gl_WorkGroupSize.x) {
            push.scene.v.chunks.v[first_chunk[kind] + i] = ListItem(index, i * CHUNK);
        }
    }
}
