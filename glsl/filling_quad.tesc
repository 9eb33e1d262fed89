#version 460
// variants: corners=CORNERS midpoints=MIDPOINTS
// Patch-filling quads: irregular faces of the last level between limit points (FAS section 4.1).
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"

#if defined(MIDPOINTS)
// Fractional-even edges have two segments at least: the limits of their middles and of the centre come along.
#define POINT_COUNT 9
const float SEGMENTS = 2.0;
#else
#define POINT_COUNT 4
const float SEGMENTS = 1.0;
#endif

layout(vertices = POINT_COUNT) out;
layout(location = 0) in uint patch_index[];
layout(location = 0) out vec3 limit_position[];
layout(location = 1) out vec3 limit_normal[];
layout(location = 2) patch out uvec4 patch_words; // its PatchInfo, and its number

void main()
{
    uint quad = patch_index[0];
    uint i = gl_InvocationID;
#if defined(MIDPOINTS)
    FillingQuadsMidpoints quads = FillingQuadsMidpoints(push.patches);
    uint place = i < 4 ? quads.v[quad].corners[i] : quads.v[quad].midpoints[i - 4];
#else
    FillingQuads quads = FillingQuads(push.patches);
    uint place = quads.v[quad].corners[i];
#endif
    LimitPoint limit = LimitPoints(push.points).v[place];
    limit_position[gl_InvocationID] = limit.position;
    limit_normal[gl_InvocationID] = limit.normal;
    if (i == 0) {
        PatchInfo info = quads.v[quad].info;
        patch_words = uvec4(info.ptex_face, info.corner, info.flags, push.first_patch_id + quad);
        gl_TessLevelOuter = float[4](SEGMENTS, SEGMENTS, SEGMENTS, SEGMENTS);
        gl_TessLevelInner = float[2](SEGMENTS, SEGMENTS);
    }
}
