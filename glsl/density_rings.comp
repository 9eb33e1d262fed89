#version 460
// variants: middles=MIDDLES vertices=VERTICES around=AROUND
// One thread gathers what lies around one vertex: the largest density, and the planes of the view that all of it lies outside of.
// Before, MIDDLES does so for the corners of each face of other than four sides, whose middle has their mean; after, AROUND finds
// the planes that all around such a face lies outside of. CPU twin: crates/subdiv/src/selection.rs.
#extension GL_GOOGLE_include_directive : require
#include "shared/scene.glsl"
layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform RingsPush {
    SceneTables scene;
} push;

// An entry of a ring with this bit belongs to a face of more than four sides.
const uint WIDE = 0x80000000u;
// What such a face's corners count in rings: its middle is the mean of more than four, up to all but two of which may be as dense.
const float WIDE_FACTOR = 1.5;

#if defined(VERTICES)
const uint LIST = LIST_VERTICES;
#else
const uint LIST = LIST_MIDDLES;
#endif

void main()
{
    uint chunk = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (chunk >= push.scene.v.heads.v[LIST].count) {
        return;
    }
    ListItem item = push.scene.v.chunks.v[push.scene.v.chunk_first[LIST] + chunk];
    Object object = push.scene.v.objects.v[item.object];
    uint slot = item.place + gl_LocalInvocationID.x;
#if defined(VERTICES)
    uint slot_end = object.vertex_count;
#else
    slot += object.vertex_count;
    uint slot_end = object.slot_count;
#endif
    if (slot >= slot_end) {
        return;
    }
    uint first = push.scene.v.ring_first.v[object.first_mesh_slot + slot];
    uint end = push.scene.v.ring_first.v[object.first_mesh_slot + slot + 1u];
    SlotDensities densities = push.scene.v.densities;
    float ring = 0.0;
    precise float sum = 0.0;
    uint outside = first == end ? 0u : 31u;
    for (uint i = first; i < end; ++i) {
        uint entry = push.scene.v.rings.v[i];
        SlotDensity other = densities.v[object.first_slot + (entry & ~WIDE)];
#if defined(MIDDLES)
        outside &= other.outside;
        sum += other.density;
        ring = max(ring, other.density);
#elif defined(VERTICES)
        // Large faces stand in the rings of their vertices themselves.
        bool is_face = (entry & ~WIDE) >= object.vertex_count;
        outside &= is_face ? other.ring_outside : other.outside;
        precise float wide = WIDE_FACTOR * other.density;
        ring = max(ring, is_face ? other.ring : ((entry & WIDE) != 0u ? wide : other.density));
#else
        outside &= other.ring_outside;
#endif
    }
#if defined(MIDDLES)
    uint corner_count = end - first;
    precise float mean = sum / float(corner_count);
    precise float wide = WIDE_FACTOR * ring;
    // A rounded mean must not be above what it is the mean of.
    densities.v[object.first_slot + slot].density = min(mean, ring);
    densities.v[object.first_slot + slot].ring = corner_count > 4u ? wide : ring;
#elif defined(VERTICES)
    densities.v[object.first_slot + slot].ring = ring;
#endif
    densities.v[object.first_slot + slot].ring_outside = outside;
}
