#version 460
// variants: patches=PATCHES leaves=LEAVES cut=CUT gregory=GREGORY_PATCHES gregory_cut=GREGORY_CUT
// Hands on what may be seen to the draw lists (DFAS section 6.1). PATCHES and LEAVES: one thread a patch; patches of more
// segments than the tessellator makes go to the CUT variant, whose groups hand on the pieces of one patch each. GREGORY_PATCHES and
// GREGORY_CUT do the same for irregular faces that are drawn as Gregory patches.
#extension GL_GOOGLE_include_directive : require
#include "shared/append.glsl"
#include "shared/control_points.glsl"
#include "shared/entry.glsl"
#include "shared/factors.glsl"
layout(local_size_x = 64) in;

// Vertices that one draw should generate on a software driver; 0: all patches are one draw.
layout(constant_id = 1) const uint BATCH_VERTICES = 0;
// Whether frames may cull at all: without it the tests are not even compiled.
layout(constant_id = 2) const bool CULL = true;

layout(push_constant, scalar) uniform EmitPush {
    SceneTables scene;
    uint list; // LIST_BASE, whose entries are chunks, LIST_PATCHES, LIST_LEAVES or LIST_CUT
} push;

#include "shared/draw_lists.glsl"

#if defined(LEAVES) || defined(GREGORY_PATCHES) || defined(GREGORY_CUT)
uint split_edges_of(Object object, uint place)
{
    uint result = 0u;
    for (uint i = 0; i < 4; ++i) {
        result |= is_split(object, push.scene.v.irregular.v[place].edges[i]) ? 1u << i : 0u;
    }
    return result;
}
#endif

#if defined(LEAVES)
#include "shared/quad_visibility.glsl"

shared uint level_counts[LEVEL_COUNT];

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint thread = group * CHUNK + gl_LocalInvocationID.x;
    for (uint i = gl_LocalInvocationID.x; i < LEVEL_COUNT; i += CHUNK) {
        level_counts[i] = 0u;
    }
    barrier();
    bool is_seen = thread < list_length(push.scene.v.heads, LIST_LEAVES);
    if (GREGORY && is_seen) {
        is_seen = gregory_kind(push.scene.v.gregory.v[push.scene.v.leaf_items.v[thread].place].flags) == GREGORY_NONE;
    }
    DrawEntry entry;
    if (is_seen) {
        ListItem item = push.scene.v.leaf_items.v[thread];
        Object object = push.scene.v.objects.v[item.object];
        FrameInput frame = push.scene.v.frame_input.v;
        uint split_edges = split_edges_of(object, item.place);
        vec3 points[8];
        for (uint i = 0; i < 4; ++i) {
            uint corner = push.scene.v.irregular.v[item.place].limits[i];
            points[i] = to_world(object, push.scene.v.limits.v[corner].position);
            uint middle = (split_edges >> i & 1u) != 0u ? push.scene.v.irregular.v[item.place].midpoints[i] : corner;
            points[4u + i] = to_world(object, push.scene.v.limits.v[middle].position);
        }
        is_seen = !is_culled(frame) || !is_quad_unseen(points, split_edges, frame.view, culls_back(frame, object), object.displacement);
        // The inner level of an uneven quad is 2: its middle makes a triangle with each segment of its edges.
        uint triangles = split_edges == 0u ? 2u : 4u + bitCount(split_edges);
        entry = DrawEntry(item.place, item.object, entry_flags(split_edges, 0u, uvec2(0u)), triangles, vec4(0.0), vec4(0.0), vec2(0.0));
        if (is_seen) {
            atomicAdd(level_counts[patch_level(push.scene.v.irregular.v[item.place].info)], 1u);
        }
    }
    append_entries(DRAW_FILLING, is_seen, entry, 8u);
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < LEVEL_COUNT; i += CHUNK) {
        if (level_counts[i] != 0u) {
            atomicAdd(push.scene.v.counts.v.filling[i], level_counts[i]);
        }
    }
}
#endif

#if defined(PATCHES) || defined(CUT)
uint split_edges_of(Object object, uint place)
{
    uint result = 0u;
    for (uint i = 0; i < 4; ++i) {
        result |= is_split(object, push.scene.v.patches.v[place].edges[i]) ? 1u << i : 0u;
    }
    return result;
}

void control_points(Object object, uint place, PatchInfo info, out vec3 points[16])
{
    [[unroll]] for (int i = 0; i < 16; ++i) {
        points[i] = to_world(object, stored_point(push.scene.v.patches, push.scene.v.points, place, i));
    }
    reflect_points(points, patch_boundary(info));
}
#endif

#if defined(PATCHES) || defined(GREGORY_PATCHES)
shared uint level_counts[2 * LEVEL_COUNT];
shared uint cut_patch_count;
shared uint first_cut;

// The place in a list of patches that are cut, of the patch of this thread, if it is one: then its place among those of the group is
// given. Else, and where it does not fit, NONE. A group of the CUT variants goes over one patch.
uint append_cut(uint list, bool is_cut, uint place)
{
    barrier();
    if (gl_LocalInvocationID.x == 0u && cut_patch_count != 0u) {
        first_cut = atomicAdd(push.scene.v.heads.v[list].count, cut_patch_count);
        uint groups = min(first_cut + cut_patch_count, push.scene.v.heads.v[list].capacity);
        atomicMax(push.scene.v.heads.v[list].groups_x, min(groups, 65535u));
        atomicMax(push.scene.v.heads.v[list].groups_y, (groups + 65534u) / 65535u);
    }
    barrier();
    return is_cut && first_cut + place < push.scene.v.heads.v[list].capacity ? first_cut + place : NONE;
}
#endif

#if defined(PATCHES)

// The patch that a thread is for; false for none.
bool patch_of(uint group, out ListItem item)
{
    item = ListItem(0u, 0u);
    if (push.list == LIST_BASE) {
        if (group >= push.scene.v.heads.v[LIST_BASE].count) {
            return false;
        }
        item = push.scene.v.chunks.v[push.scene.v.chunk_first[3] + group];
        Object object = push.scene.v.objects.v[item.object];
        uint place = item.place + gl_LocalInvocationID.x;
        item.place = object.first_patch + place;
        return place < object.patch_count;
    }
    uint thread = group * CHUNK + gl_LocalInvocationID.x;
    if (thread >= list_length(push.scene.v.heads, LIST_PATCHES)) {
        return false;
    }
    item = push.scene.v.patch_items.v[thread];
    return true;
}

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    for (uint i = gl_LocalInvocationID.x; i < 2u * LEVEL_COUNT; i += CHUNK) {
        level_counts[i] = 0u;
    }
    if (gl_LocalInvocationID.x == 0u) {
        cut_patch_count = 0u;
    }
    barrier();
    ListItem item;
    bool is_seen = patch_of(group, item);
    uint pieces = 0u;
    uint vertices = 1u;
    uint split_edges = 0u;
    uint cut_place = 0u;
    DrawEntry entry;
    if (is_seen) {
        Object object = push.scene.v.objects.v[item.object];
        FrameInput frame = push.scene.v.frame_input.v;
        PatchInfo info = push.scene.v.patches.v[item.place].info;
        split_edges = split_edges_of(object, item.place);
        PatchFactors factors = patch_factors(face_density(push.scene, object, info.ptex_face), info, split_edges);
        pieces = cut_count(factors);
        // The tangents of a patch with a semi-sharp crease are not those of its control points: it is always drawn.
        if (is_culled(frame) && push.scene.v.patches.v[item.place].sharpness == 0.0) {
            vec3 points[16];
            vec3 bezier[16];
            control_points(object, item.place, info, points);
            bezier_patch(points, bezier);
            bool cull_back = culls_back(frame, object) && pieces == 1u;
            is_seen = !is_patch_unseen(bezier, frame.view, grain_of(factors), cull_back, object.displacement);
        }
        uvec2 inner = uvec2(factors.inner_counts);
        vertices = (inner.x + 1u) * (inner.y + 1u);
        entry = DrawEntry(item.place, item.object, entry_flags(split_edges, 0u, uvec2(0u)),
                          triangle_count(uvec4(factors.counts), inner), factors.low, factors.high, factors.inner);
        if (is_seen) {
            uint level = patch_level(info);
            atomicAdd(level_counts[split_edges != 0u ? LEVEL_COUNT + level : level], 1u);
            if (pieces > 1u) {
                cut_place = atomicAdd(cut_patch_count, 1u);
            }
        }
    }
    append_entries(DRAW_REGULAR, is_seen && pieces == 1u && split_edges == 0u, entry, vertices);
    append_entries(DRAW_TRANSITION, is_seen && pieces == 1u && split_edges != 0u, entry, vertices);
    uint cut = append_cut(LIST_CUT, is_seen && pieces > 1u, cut_place);
    if (cut != NONE) {
        push.scene.v.cut_items.v[cut] = item;
    }
    for (uint i = gl_LocalInvocationID.x; i < LEVEL_COUNT; i += CHUNK) {
        if (level_counts[i] != 0u) {
            atomicAdd(push.scene.v.counts.v.regular[i], level_counts[i]);
        }
        if (level_counts[LEVEL_COUNT + i] != 0u) {
            atomicAdd(push.scene.v.counts.v.transition[i], level_counts[LEVEL_COUNT + i]);
        }
    }
}
#endif

#if defined(CUT)
void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (group >= list_length(push.scene.v.heads, LIST_CUT)) {
        return;
    }
    ListItem item = push.scene.v.cut_items.v[group];
    Object object = push.scene.v.objects.v[item.object];
    FrameInput frame = push.scene.v.frame_input.v;
    PatchInfo info = push.scene.v.patches.v[item.place].info;
    uint split_edges = split_edges_of(object, item.place);
    PatchFactors factors = patch_factors(face_density(push.scene, object, info.ptex_face), info, split_edges);
    uint pieces = cut_count(factors);
    bool is_tested = is_culled(frame) && push.scene.v.patches.v[item.place].sharpness == 0.0;
    vec3 points[16];
    vec3 whole[16];
    control_points(object, item.place, info, points);
    bezier_patch(points, whole);
    // All threads go round together: they append together.
    for (uint first = 0u; first < pieces * pieces; first += CHUNK) {
        uint i = first + gl_LocalInvocationID.x;
        uvec2 piece = uvec2(i % pieces, i / pieces);
        PieceFactors own = piece_factors(factors, pieces, piece);
        bool is_seen = i < pieces * pieces;
        if (is_seen && is_tested) {
            vec3 bezier[16] = whole;
            vec2 low;
            vec2 high;
            piece_bounds(factors, own, pieces, piece, low, high);
            bezier_part(bezier, low, high);
            is_seen = !is_patch_unseen(bezier, frame.view, Grain(1.0, 0.0, 0.0, false), false, object.displacement);
        }
        DrawEntry entry = DrawEntry(item.place, item.object, entry_flags(split_edges, pieces, piece),
                                    triangle_count(own.counts, own.inner), factors.low, factors.high, factors.inner);
        append_entries(DRAW_CUT, is_seen, entry, (own.inner.x + 1u) * (own.inner.y + 1u));
    }
}
#endif

#if defined(GREGORY_PATCHES) || defined(GREGORY_CUT)
#include "shared/emit_gregory.glsl"
#endif
