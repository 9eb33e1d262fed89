#version 460
// ACC patches (Loop and Schaefer 2008): makes the 16 points of the bicubic patch, and of the patches of tangents what these do not give.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/rival.glsl"
#include "shared/entry.glsl"
#include "shared/factors.glsl"

layout(constant_id = 3) const bool CUT = false; // each is a piece of a patch
layout(vertices = 32) out;
layout(location = 0) in uint list_place[];
layout(location = 0) out vec3 control_point[]; // of each corner p, e+, e-, the inner one; then of each edge the tangents at
                                               // its ends, and the derivatives into the face next to them
layout(location = 1) patch out vec4 low_factors;
layout(location = 2) patch out vec4 high_factors;
layout(location = 3) patch out vec2 inner_factors;
layout(location = 4) patch out uvec4 patch_words;
layout(location = 5) patch out uvec3 piece_place;
layout(location = 6) patch out uvec4 piece_first;
layout(location = 7) patch out uvec4 piece_last;
layout(location = 8) patch out uvec2 patch_places; // of the face, and of its object
layout(location = 9) out vec3 edge_across[];       // four of the field across each edge

#include "shared/levels.glsl"
#include "shared/rival_entry.glsl"

precise vec3 tangent(vec3 from, vec3 to)
{
    precise vec3 result = 3.0 * (to - from);
    return result;
}

// Derivative into the face beside the first end of an edge: `r` points into it, `near` is the tangent at that end, `middle` the one of the
// curve's middle; `c` is the cosine at that end.
precise vec3 inward(vec3 r, vec3 near, vec3 middle, float c, float far_c)
{
    precise vec3 result = r + ((2.0 * c) * middle - far_c * near) / 3.0;
    return result;
}

vec3 point_of_corner(SceneTables scene, GregoryFace face, uint corner, uint which)
{
    if (which == 0u) {
        return corner_position(scene, face, corner);
    }
    if (which == 1u) {
        return middle_out(scene, face, corner);
    }
    if (which == 2u) {
        return middle_into(scene, face, (corner + 3u) & 3u);
    }
    return inner_point(scene, face, corner);
}

vec3 vector_of_edge(SceneTables scene, GregoryFace face, uint edge, uint which)
{
    SpokePoint from = spoke_out(scene, face, edge);
    SpokePoint to = spoke_into(scene, face, edge);
    vec3 first = tangent(corner_position(scene, face, edge), from.edge);
    vec3 last = tangent(to.edge, corner_position(scene, face, edge + 1u));
    if (which < 2u) {
        return which == 0u ? first : last;
    }
    vec3 middle = tangent(middle_out(scene, face, edge), middle_into(scene, face, edge));
    float c0 = face.cosines[edge];
    float c1 = face.cosines[(edge + 1u) & 3u];
    return which == 2u ? inward(from.beside, first, middle, c0, c1) : inward(-to.beside, -last, -middle, c1, c0);
}

void main()
{
    DrawEntry entry = push.list.v[list_place[0]];
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[entry.object];
    GregoryFace face = scene.v.gregory.v[entry.place];
    uint i = gl_InvocationID;
    vec3 made = vec3(0.0);
    vec3 across = vec3(0.0);
    for (bool is_open = i < 16u; is_open; is_open = false) {
        made = to_world(object, point_of_corner(scene, face, i / 4u, i & 3u));
        across = to_world_vector(object, across_edge(scene, face, i / 4u, i & 3u, 1.0));
    }
    for (bool is_open = i >= 16u; is_open; is_open = false) {
        made = to_world_vector(object, vector_of_edge(scene, face, i / 4u - 4u, i & 3u));
    }
    control_point[gl_InvocationID] = made;
    edge_across[gl_InvocationID] = across;
    if (i == 0u) {
        put_patch(scene, object, entry);
    }
}
