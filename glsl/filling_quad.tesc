#version 460
// Patch-filling quads: irregular faces that are not refined, between limit points (FAS section 4.1). Where the neighbour is
// refined there is one at the middle of the edge too.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/entry.glsl"

layout(vertices = 8) out;
layout(location = 0) in uint list_place[];
layout(location = 0) out vec3 limit_position[]; // of corners 0 to 3, and the middles of edges 0 to 3
layout(location = 1) out vec3 limit_normal[];
layout(location = 2) patch out uvec4 patch_words; // its PatchInfo, and its number
layout(location = 3) patch out uint fan; // which of the points all triangles of an uneven quad meet at; else NONE

void main()
{
    DrawEntry entry = push.list.v[list_place[0]];
    uint face = entry.place;
    uint i = gl_InvocationID;
    IrregularFaces faces = IrregularFaces(push.patches);
    uint split_edges = entry_split_edges(entry.flags);
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[entry.object];
    // What is not split has no middle: its corner stands in.
    uint edge = i & 3u;
    bool is_middle = i >= 4u && (split_edges >> edge & 1u) != 0u;
    uint place = is_middle ? faces.v[face].midpoints[edge] : faces.v[face].limits[edge];
    LimitPoint limit = LimitPoints(push.points).v[place];
    limit_position[gl_InvocationID] = to_world(object, limit.position);
    limit_normal[gl_InvocationID] = normal_to_world(object, limit.normal);
    if (i == 0) {
        PatchInfo info = faces.v[face].info;
        bool is_mirrored = (object.flags & OBJECT_MIRRORED) != 0u;
        patch_words = uvec4(object.first_face + info.ptex_face, info.corner, info.flags,
                            (push.first_patch_id + face) | (is_mirrored ? PATCH_MIRRORED : 0u));
        fan = split_edges == 0u ? NONE : 4u + uint(findLSB(split_edges));
        vec4 counts = 1.0 + vec4(uvec4(split_edges) >> uvec4(0, 1, 2, 3) & 1u);
        gl_TessLevelOuter[0] = counts.w;
        gl_TessLevelOuter[1] = counts.x;
        gl_TessLevelOuter[2] = counts.y;
        gl_TessLevelOuter[3] = counts.z;
        float inner = split_edges == 0u ? 1.0 : 2.0;
        gl_TessLevelInner[0] = inner;
        gl_TessLevelInner[1] = inner;
    }
}
