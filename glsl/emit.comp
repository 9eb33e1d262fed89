#version 460
// variants: bspline=BSPLINE corners=CORNERS midpoints=MIDPOINTS
// One group takes one batch of a list and hands on those of its patches that may be seen, in order, and the draw of them.
// Nothing is counted across batches before the draws, so no order depends on which group ran first.
#extension GL_GOOGLE_include_directive : require
#include "shared/tables.glsl"
#include "shared/control_points.glsl"
#include "shared/visibility.glsl"
layout(local_size_x_id = 1) in;
layout(local_size_x = 64) in;

// The most patches of a batch.
layout(constant_id = 0) const uint MAX_BATCH = 256;
const uint SEEN_WORDS = (MAX_BATCH + 31) / 32;

// VkDrawIndirectCommand: a vertex is a patch.
struct DrawArguments {
    uint vertex_count;
    uint instance_count;
    uint first_vertex;
    uint first_instance;
};

// Patches of one kind, by level.
struct EmitCounts {
    uint levels[LEVEL_COUNT];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SourceDraws { DrawArguments v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer VisibleDraws { DrawArguments v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer VisibleList { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EmitLevels { EmitLevel v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer EmitCountsOfKind { EmitCounts v; };

layout(push_constant, scalar) uniform EmitPush {
    Indices list;              // patches of the kind, as indices into the table
    VisibleList visible;       // those that may be seen, each batch's from its own first place on
    Points points;             // control points; limit points for filling quads
    RegularPatches patches;    // table of patches; filling quads for their variants
    SourceDraws draws;         // the batches of the list
    VisibleDraws visible_draws;
    EmitLevels levels;
    EmitCountsOfKind counts;   // visible patches, added to
    EmitView view;
    uint batch_count;
} push;

shared uint seen[SEEN_WORDS];
shared uint level_counts[LEVEL_COUNT];

#if defined(BSPLINE)
PatchInfo info_of(uint place)
{
    return push.patches.v[place].info;
}

bool is_unseen(uint place)
{
    PatchInfo info = info_of(place);
    vec3 points[16];
    [[unroll]] for (int i = 0; i < 16; ++i) {
        points[i] = stored_point(push.patches, push.points, place, i);
    }
    reflect_points(points, patch_boundary(info));
    bool is_uneven = (patch_transition(info) | patch_leaf(info)) != 0u;
    // The tangents of a patch with a semi-sharp crease are not those of its control points: it is always drawn.
    bool is_creased = push.patches.v[place].sharpness != 0.0;
    return !is_creased && is_patch_unseen(points, push.view, push.levels.v[patch_level(info)], is_uneven);
}
#else
#if defined(MIDPOINTS)
#define POINT_COUNT 9
#define QUAD_COUNT 4
#define QUADS FillingQuadsMidpoints
// The quads between corners 0 to 3, middles of edges 4 to 7 and the centre 8.
const uvec4 CORNERS_OF[4] = uvec4[4](uvec4(0, 4, 8, 7), uvec4(4, 1, 5, 8), uvec4(8, 5, 2, 6), uvec4(7, 8, 6, 3));
#else
#define POINT_COUNT 4
#define QUAD_COUNT 1
#define QUADS FillingQuads
const uvec4 CORNERS_OF[1] = uvec4[1](uvec4(0, 1, 2, 3));
#endif

PatchInfo info_of(uint place)
{
    return QUADS(push.patches).v[place].info;
}

bool is_unseen(uint place)
{
    vec3 p[POINT_COUNT];
    [[unroll]] for (int i = 0; i < POINT_COUNT; ++i) {
        uint limit = QUADS(push.patches).v[place].corners[min(i, 3)];
#if defined(MIDPOINTS)
        if (i > 3) {
            limit = QUADS(push.patches).v[place].midpoints[max(i, 4) - 4];
        }
#endif
        p[i] = LimitPoints(push.points).v[limit].position;
    }
    float largest_offset = 0.0;
    float largest = 0.0;
    [[unroll]] for (int i = 0; i < POINT_COUNT; ++i) {
        precise vec3 offset = p[i] - push.view.eye;
        largest_offset = max(largest_offset, largest_component(offset));
        largest = max(largest, largest_component(p[i]));
    }
    Scale scale = scale_of(push.view, 1.0, largest_offset, largest);
    uint planes = 31u;
    [[unroll]] for (int i = 0; i < POINT_COUNT; ++i) {
        precise vec3 offset = p[i] * scale.factor - scale.eye;
        p[i] = offset;
        planes &= outside_planes(offset, push.view, scale);
    }
    precise float error = scale.rounding + CUBE_DIAGONAL * push.view.snap;
    bool is_turned = push.view.cull_back != 0u;
    [[unroll]] for (int i = 0; i < QUAD_COUNT; ++i) {
        uvec4 c = CORNERS_OF[i];
        is_turned = is_turned && is_quad_turned(p[c.x], p[c.y], p[c.z], p[c.w], error, scale.eye_rounding);
    }
    return planes != 0u || is_turned;
}
#endif

void main()
{
    uint batch = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (batch >= push.batch_count) {
        return;
    }
    uint thread = gl_LocalInvocationID.x;
    for (uint i = thread; i < SEEN_WORDS; i += gl_WorkGroupSize.x) {
        seen[i] = 0;
    }
    for (uint i = thread; i < LEVEL_COUNT; i += gl_WorkGroupSize.x) {
        level_counts[i] = 0;
    }
    barrier();
    DrawArguments draw = push.draws.v[batch];
    uint count = min(draw.vertex_count, MAX_BATCH);
    // Loops, not branches: a software driver runs the body of a branch that no thread takes, but not that of a loop.
    for (uint i = thread; i < count; i += gl_WorkGroupSize.x) {
        uint place = push.list.v[draw.first_vertex + i];
        if (!is_unseen(place)) {
            atomicOr(seen[i / 32], 1u << (i % 32));
            atomicAdd(level_counts[patch_level(info_of(place))], 1);
        }
    }
    barrier();
    for (uint i = thread; i < count; i += gl_WorkGroupSize.x) {
        uint word = seen[i / 32];
        uint rank = bitCount(word & ((1u << (i % 32)) - 1));
        for (uint before = 0; before < i / 32; ++before) {
            rank += bitCount(seen[before]);
        }
        if ((word >> (i % 32) & 1u) != 0u) {
            push.visible.v[draw.first_vertex + rank] = push.list.v[draw.first_vertex + i];
        }
    }
    if (thread == 0) {
        draw.vertex_count = 0;
        for (uint word = 0; word < SEEN_WORDS; ++word) {
            draw.vertex_count += bitCount(seen[word]);
        }
        push.visible_draws.v[batch] = draw;
    }
    for (uint i = thread; i < LEVEL_COUNT; i += gl_WorkGroupSize.x) {
        if (level_counts[i] != 0) {
            atomicAdd(push.counts.v.levels[i], level_counts[i]);
        }
    }
}
