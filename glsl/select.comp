#version 460
// One thread decides whether one irregular face is refined, level by level (DFAS section 6.1; the rule is that of
// docs/src/papers/dfas.md). CPU twin: crates/subdiv/src/selection.rs.
#extension GL_GOOGLE_include_directive : require
#include "shared/append.glsl"
#include "shared/density.glsl"
#include "shared/marks.glsl"
layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    SceneTables scene;
    uint level;
} push;

// How much denser than its own corners the faces around a face may be before it is refined for their sake.
const float RING_LIMIT = 3.0;

shared uint child_count;
shared uint patch_count;
shared uint leaf_count;
shared uint truncated_count;
shared uint first_child;
shared uint first_patch;
shared uint first_leaf;

SlotDensity slot_of(Object object, uint slot)
{
    return push.scene.v.densities.v[object.first_slot + slot];
}

// The largest density of the faces of the cage that touch a face, as far as it can be told from their corners.
float ring_density(Object object, PatchInfo info, FaceDensity face)
{
    uvec4 slots = corner_slots(push.scene, object, info.ptex_face);
    uvec2 low = uvec2(info.corner & 0xffffu, info.corner >> 16);
    uint last = (1u << patch_depth(info)) - 1u;
    // Whether it touches the sides v = 0, u = 1, v = 1 and u = 0 of the Ptex face.
    bvec4 side = bvec4(low.y == 0u, low.x == last, low.y == last, low.x == 0u);
    if (face.is_part) {
        float largest = slot_of(object, slots.z & ~PART_OF_FACE).ring;
        float own = slot_of(object, slots.x).ring;
        largest = side.x && side.w ? max(largest, own) : largest;
        largest = side.x ? max(largest, min(own, slot_of(object, slots.y).ring)) : largest;
        return side.w ? max(largest, min(own, slot_of(object, slots.w).ring)) : largest;
    }
    float largest = max(max(face.at.x, face.at.y), max(face.at.z, face.at.w));
    vec4 ring = vec4(slot_of(object, slots.x).ring, slot_of(object, slots.y).ring, slot_of(object, slots.z).ring,
                     slot_of(object, slots.w).ring);
    [[dont_unroll]] for (uint i = 0; i < 4; ++i) {
        uint next = (i + 1u) & 3u;
        uint previous = (i + 3u) & 3u;
        largest = side[i] && side[previous] ? max(largest, ring[i]) : largest;
        largest = side[i] ? max(largest, min(ring[i], ring[next])) : largest;
    }
    return largest;
}

// Whether all that a face of level 0 may become lies outside of the view.
bool is_unseen(Object object, PatchInfo info)
{
    if (push.scene.v.frame_input.v.view.cull == 0u || (object.flags & OBJECT_IN_HULL) == 0u) {
        return false;
    }
    uvec4 slots = corner_slots(push.scene, object, info.ptex_face);
    if ((slots.z & PART_OF_FACE) != 0u) {
        return slot_of(object, slots.z & ~PART_OF_FACE).ring_outside != 0u;
    }
    uint planes = slot_of(object, slots.x).ring_outside & slot_of(object, slots.y).ring_outside;
    return (planes & slot_of(object, slots.z).ring_outside & slot_of(object, slots.w).ring_outside) != 0u;
}

// The face that a thread is for; false for none.
bool face_of(uint group, out ListItem item)
{
    item = ListItem(0u, 0u);
    if (push.level == 0u) {
        if (group >= push.scene.v.heads.v[LIST_ROOTS].count) {
            return false;
        }
        item = push.scene.v.chunks.v[push.scene.v.chunk_first[2] + group];
        Object object = push.scene.v.objects.v[item.object];
        uint root = item.place + gl_LocalInvocationID.x;
        item.place = object.first_root + root;
        return root < object.root_count;
    }
    uint thread = group * CHUNK + gl_LocalInvocationID.x;
    if (thread >= list_length(push.scene.v.heads, LIST_ACTIVE + push.level)) {
        return false;
    }
    item = push.scene.v.active_faces.v[push.scene.v.first_active[push.level] + thread];
    return true;
}

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (gl_LocalInvocationID.x == 0u) {
        child_count = 0u;
        patch_count = 0u;
        leaf_count = 0u;
        truncated_count = 0u;
    }
    barrier();
    ListItem item;
    bool is_there = face_of(group, item);
    bool is_seen = false;
    bool is_refined = false;
    uint children[4] = uint[4](NONE, NONE, NONE, NONE);
    uint child_place = 0u;
    uint patch_place = 0u;
    uint leaf_place = 0u;
    bool is_leaf = false;
    if (is_there) {
        Object object = push.scene.v.objects.v[item.object & ~ITEM_UNSEEN];
        FrameInput frame = push.scene.v.frame_input.v;
        PatchInfo info = push.scene.v.irregular.v[item.place].info;
        uint flags = push.scene.v.irregular.v[item.place].flags;
        if (push.level == 0u && is_unseen(object, info)) {
            item.object |= ITEM_UNSEEN;
        }
        is_seen = (item.object & ITEM_UNSEEN) == 0u;
        float scale = halvings(push.level);
        bool is_wanted;
        bool is_short; // of density where it ends
        if (frame.selection == SELECT_STATIC) {
            precise float density = uintBitsToFloat(push.scene.v.counts.v.density_bits) * scale;
            is_wanted = density > 1.0;
            is_short = is_wanted;
        } else {
            FaceDensity face = face_density(push.scene, object, info.ptex_face);
            vec4 corners = corner_densities(face, info);
            precise float own = max(max(corners.x, corners.y), max(corners.z, corners.w)) * scale;
            precise float ring = ring_density(object, info, face) * scale;
            is_short = own > 1.0;
            is_wanted = is_short || ring > RING_LIMIT;
        }
        bool is_forced = (flags & FACE_FORCED) != 0u;
        is_refined = is_forced || (is_wanted && push.level < frame.max_level);
        is_leaf = !is_refined && is_seen && (flags & FACE_HIDDEN) == 0u;
        if (is_refined) {
            [[dont_unroll]] for (uint i = 0; i < 4; ++i) {
                uint edge = push.scene.v.irregular.v[item.place].edges[i];
                if (edge != NONE) {
                    set_bit(push.scene.v.split_edges, object.first_edge + edge);
                }
                if (is_seen) {
                    mark_star(push.scene, push.scene.v.irregular.v[item.place].stars[i]);
                }
                children[i] = push.scene.v.irregular.v[item.place].children[i];
            }
        }
        uint finer = 0u;
        uint patches = 0u;
        [[dont_unroll]] for (uint i = 0; i < 4; ++i) {
            bool is_child = children[i] != NONE;
            bool is_irregular = (children[i] & IRREGULAR_CHILD) != 0u;
            finer += is_child && is_irregular ? 1u : 0u;
            patches += is_child && !is_irregular && is_seen ? 1u : 0u;
        }
        child_place = finer != 0u ? atomicAdd(child_count, finer) : 0u;
        patch_place = patches != 0u ? atomicAdd(patch_count, patches) : 0u;
        if (is_leaf) {
            leaf_place = atomicAdd(leaf_count, 1u);
            if (is_short) {
                atomicAdd(truncated_count, 1u);
            }
        }
    }
    barrier();
    ListHeads heads = push.scene.v.heads;
    if (gl_LocalInvocationID.x == 0u) {
        // The last level has no children.
        first_child = child_count == 0u ? 0u : take_places(heads, LIST_ACTIVE + push.level + 1u, child_count);
        first_patch = take_places(heads, LIST_PATCHES, patch_count);
        first_leaf = take_places(heads, LIST_LEAVES, leaf_count);
        if (truncated_count != 0u) {
            atomicAdd(push.scene.v.counts.v.truncated, truncated_count);
        }
    }
    barrier();
    child_place += first_child;
    patch_place += first_patch;
    [[dont_unroll]] for (uint i = 0; i < 4; ++i) {
        if (children[i] == NONE) {
            continue;
        }
        if ((children[i] & IRREGULAR_CHILD) != 0u) {
            if (child_place < heads.v[LIST_ACTIVE + push.level + 1u].capacity) {
                push.scene.v.active_faces.v[push.scene.v.first_active[push.level + 1u] + child_place] =
                    ListItem(item.object, children[i] & ~IRREGULAR_CHILD);
            }
            ++child_place;
        } else if (is_seen) {
            if (patch_place < heads.v[LIST_PATCHES].capacity) {
                push.scene.v.patch_items.v[patch_place] = ListItem(item.object, children[i]);
            }
            ++patch_place;
        }
    }
    if (is_leaf && first_leaf + leaf_place < heads.v[LIST_LEAVES].capacity) {
        push.scene.v.leaf_items.v[first_leaf + leaf_place] = item;
    }
}
