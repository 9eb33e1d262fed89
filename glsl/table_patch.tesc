#version 460
// Faces that are evaluated by table: asks for a grid of points that the table has.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/entry.glsl"

layout(vertices = 1) out;
layout(location = 0) in uint list_place[];
layout(location = 0) patch out vec4 edge_factors;
layout(location = 1) patch out uvec4 patch_words; // place of the patch, of its object, its number, segments

void main()
{
    DrawEntry entry = push.list.v[list_place[0]];
    SceneTables scene = push.frame.v.scene;
    uint object_flags = scene.v.objects.v[entry.object].flags;
    edge_factors = entry.low;
    uint number = (push.first_patch_id + entry.place) | ((object_flags & OBJECT_MIRRORED) != 0u ? PATCH_MIRRORED : 0u);
    patch_words = uvec4(entry.place, entry.object, number, entry.flags);
    // Of all sides alike: what an edge has fewer of are points that lie on others.
    float segments = float(entry.flags);
    gl_TessLevelOuter[0] = segments;
    gl_TessLevelOuter[1] = segments;
    gl_TessLevelOuter[2] = segments;
    gl_TessLevelOuter[3] = segments;
    gl_TessLevelInner[0] = segments;
    gl_TessLevelInner[1] = segments;
}
