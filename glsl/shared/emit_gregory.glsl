// The GREGORY_PATCHES and GREGORY_CUT variants of emit.comp: irregular faces that are drawn as Gregory patches. CPU twin:
// crates/render/src/emit_gregory.rs.
#ifndef PLANISH_EMIT_GREGORY
#define PLANISH_EMIT_GREGORY
#include "gregory_visibility.glsl"

#if defined(GREGORY_PATCHES)
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
    uint thread = group * CHUNK + gl_LocalInvocationID.x;
    bool is_seen = thread < list_length(push.scene.v.heads, LIST_LEAVES);
    if (is_seen) {
        is_seen = gregory_kind(push.scene.v.gregory.v[push.scene.v.leaf_items.v[thread].place].flags) != GREGORY_NONE;
    }
    ListItem item = ListItem(0u, 0u);
    uint pieces = 0u;
    uint vertices = 1u;
    uint cut_place = 0u;
    bool is_triangle = false;
    DrawEntry entry;
    if (is_seen) {
        item = push.scene.v.leaf_items.v[thread];
        Object object = push.scene.v.objects.v[item.object];
        FrameInput frame = push.scene.v.frame_input.v;
        PatchInfo info = push.scene.v.irregular.v[item.place].info;
        GregoryFace face = push.scene.v.gregory.v[item.place];
        is_triangle = gregory_kind(face) == GREGORY_TRIANGLE;
        uint split_edges = split_edges_of(object, item.place);
        PatchFactors factors = patch_factors(face_density(push.scene, object, info.ptex_face), info, split_edges);
        pieces = cut_count(factors);
        if (is_culled(frame)) {
            bool cull_back = culls_back(frame, object) && pieces == 1u && !has_creased_border(push.scene, face);
            is_seen = !is_gregory_unseen(push.scene, object, face, item.place, frame.view, grain_of(factors), cull_back);
        }
        uvec2 inner = uvec2(factors.inner_counts);
        vertices = (inner.x + 1u) * (inner.y + 1u);
        entry = DrawEntry(item.place, item.object, entry_flags(split_edges, 0u, uvec2(0u)),
                          triangle_count(uvec4(factors.counts), inner), factors.low, factors.high, factors.inner);
        // A triangle is one patch: its first third is counted.
        if (is_seen && (!is_triangle || gregory_part(face) == 0u)) {
            atomicAdd(level_counts[patch_level(info) + (is_triangle ? LEVEL_COUNT - 1u : 0u)], 1u);
        }
        if (is_seen && pieces > 1u) {
            cut_place = atomicAdd(cut_patch_count, 1u);
        }
    }
    append_entries(DRAW_GREGORY, is_seen && pieces == 1u && !is_triangle, entry, vertices);
    append_entries(DRAW_TRIANGLE, is_seen && pieces == 1u && is_triangle, entry, vertices);
    uint cut = append_cut(LIST_CUT_GREGORY, is_seen && pieces > 1u, cut_place);
    if (cut != NONE) {
        push.scene.v.cut_gregory_items.v[cut] = item;
    }
    for (uint i = gl_LocalInvocationID.x; i < LEVEL_COUNT; i += CHUNK) {
        if (level_counts[i] != 0u) {
            atomicAdd(push.scene.v.counts.v.gregory[i], level_counts[i]);
        }
        if (level_counts[LEVEL_COUNT + i] != 0u) {
            atomicAdd(push.scene.v.counts.v.triangle[i], level_counts[LEVEL_COUNT + i]);
        }
    }
}
#endif

#if defined(GREGORY_CUT)
void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (group >= list_length(push.scene.v.heads, LIST_CUT_GREGORY)) {
        return;
    }
    ListItem item = push.scene.v.cut_gregory_items.v[group];
    Object object = push.scene.v.objects.v[item.object];
    PatchInfo info = push.scene.v.irregular.v[item.place].info;
    bool is_triangle = gregory_kind(push.scene.v.gregory.v[item.place]) == GREGORY_TRIANGLE;
    uint split_edges = split_edges_of(object, item.place);
    PatchFactors factors = patch_factors(face_density(push.scene, object, info.ptex_face), info, split_edges);
    uint pieces = cut_count(factors);
    for (uint first = 0u; first < pieces * pieces; first += CHUNK) {
        uint i = first + gl_LocalInvocationID.x;
        uvec2 piece = uvec2(i % pieces, i / pieces);
        PieceFactors own = piece_factors(factors, pieces, piece);
        DrawEntry entry = DrawEntry(item.place, item.object, entry_flags(split_edges, pieces, piece),
                                    triangle_count(own.counts, own.inner), factors.low, factors.high, factors.inner);
        append_entries(is_triangle ? DRAW_TRIANGLE_CUT : DRAW_GREGORY_CUT, i < pieces * pieces, entry,
                       (own.inner.x + 1u) * (own.inner.y + 1u));
    }
}
#endif
#endif
