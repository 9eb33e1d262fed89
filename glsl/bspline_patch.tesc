#version 460
// Regular and transition patches: fetches 16 control points and sets the tess factors (FAS sections 4.1 and 4.2).
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/control_points.glsl"
#include "shared/spacing.glsl"

layout(constant_id = 2) const bool CREASE = false; // some patches have a semi-sharp crease
layout(vertices = 16) out;
layout(location = 0) in uint patch_index[];
layout(location = 0) out vec3 control_point[];
layout(location = 1) patch out vec4 low_factors;  // spaced factor of each edge, or of the half with the lower u or v
layout(location = 2) patch out vec4 high_factors; // of the other half where the neighbour was split, else 0
layout(location = 3) patch out float inner_factor;
layout(location = 4) patch out uvec4 patch_words; // its PatchInfo, and its number
layout(location = 5) patch out float patch_sharpness; // of the semi-sharp crease along one of its edges, or 0

void main()
{
    uint patch_place = patch_index[0];
    PatchInfo info = push.patches.v[patch_place].info;
    control_point[gl_InvocationID] =
        control_point_of(push.patches, push.points, patch_place, gl_InvocationID, patch_boundary(info));
    if (gl_InvocationID != 0) {
        return;
    }
    patch_words = uvec4(info.ptex_face, info.corner, info.flags, push.first_patch_id + patch_place);
    patch_sharpness = CREASE ? push.patches.v[patch_place].sharpness : 0.0;
    uint level = patch_level(info);
    float factor = spaced_factor(push.frame.v.factors[level]);
    float finer = spaced_factor(push.frame.v.factors[level + 1]);
    float least = spaced_factor(1.0);
    vec4 low = vec4(factor);
    vec4 high = vec4(0.0);
    vec4 counts;
    for (int edge = 0; edge < 4; ++edge) {
        bool split = (patch_transition(info) >> edge & 1u) != 0u;
        bool leaf = (patch_leaf(info) >> edge & 1u) != 0u;
        low[edge] = split ? finer : (leaf ? least : factor);
        high[edge] = split ? finer : 0.0;
        counts[edge] = segment_count(low[edge]) * (split ? 2.0 : 1.0);
    }
    low_factors = low;
    high_factors = high;
    // Edge 0 is v = 0, 1 is u = 1, 2 is v = 1, 3 is u = 0; the tessellator numbers u = 0, v = 0, u = 1, v = 1.
    gl_TessLevelOuter[0] = counts[3];
    gl_TessLevelOuter[1] = counts[0];
    gl_TessLevelOuter[2] = counts[1];
    gl_TessLevelOuter[3] = counts[2];
    // An inner level of 1 beside an edge of more segments would be taken as 2: say so ourselves.
    bool plain = all(equal(counts, vec4(1.0)));
    float inner = segment_count(factor);
    inner_factor = inner == 1.0 && !plain ? 2.0 : factor;
    gl_TessLevelInner[0] = inner == 1.0 && !plain ? 2.0 : inner;
    gl_TessLevelInner[1] = gl_TessLevelInner[0];
}
