#version 460
// Patch-filling quads: irregular faces that are not refined, between limit points (FAS section 4.1). Where the neighbour is
// refined there is one at the middle of the edge too.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/entry.glsl"
#include "shared/displacement.glsl"
#include "shared/tex_tree.glsl"

layout(vertices = 8) out;
layout(location = 0) in uint list_place[];
layout(location = 0) out vec3 limit_position[]; // of corners 0 to 3, and the middles of edges 0 to 3
layout(location = 1) out vec3 limit_normal[];
layout(location = 2) patch out uvec4 patch_words; // its PatchInfo, and its number
layout(location = 3) patch out uvec2 fan_and_object; // which of the points all triangles of an uneven quad meet at, else NONE
layout(location = 4) out vec3 shading_normal[]; // of the displaced surface
layout(location = 5) out vec2 tex_coord[];

// Place of each of the points in the quad.
const vec2 UVS[8] = vec2[8](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0), vec2(0.5, 0.0), vec2(1.0, 0.5),
                            vec2(0.5, 1.0), vec2(0.0, 0.5));

// Moves a limit point as every patch at it does; the normal becomes the direction. Returns the normal of the displaced surface.
vec3 displace(Object object, uint limit, PatchInfo info, vec2 uv, inout vec3 position, inout vec3 normal)
{
    SceneTables scene = push.frame.v.scene;
    DisplacementMap map = scene.v.maps.v[object.map];
    LimitSeat seat = scene.v.limit_seats.v[limit];
    vec3 own_normal = normal;
    normal = normal_to_world(object, scene.v.limits.v[seat.canonical].normal);
    MapPlace place;
    place.uv = seat.uv;
    place.ptex_face = info.ptex_face;
    ptex_place(info, Parameter(uv.x, 1.0 - uv.x), Parameter(uv.y, 1.0 - uv.y), place.u, place.v);
    float lod = density_at(face_lods(scene, object, info.ptex_face), ptex_uv(info, uv));
    MapSamples samples = sample_around(map, place, place, lod);
    position = displaced(position, displacement_vector(object, map, samples.value, normal));
    if (map.layout_kind == LAYOUT_FACES) {
        // How the tangents run in the Ptex face is not known.
        return own_normal;
    }
    LimitTangents tangents = scene.v.limit_tangents.v[limit];
    vec3 a = to_world_vector(object, tangents.a);
    vec3 b = to_world_vector(object, tangents.b);
    vec3 da = displacement_vector(object, map, samples.along_s * seat.along_a.x + samples.along_t * seat.along_a.y, normal);
    vec3 db = displacement_vector(object, map, samples.along_s * seat.along_b.x + samples.along_t * seat.along_b.y, normal);
    return displaced_normal(a, b, da, db, own_normal);
}

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
    vec3 position = to_world(object, limit.position);
    vec3 normal = normal_to_world(object, limit.normal);
    if (DISPLACED) {
        shading_normal[gl_InvocationID] = normal;
        if (object.map != NONE) {
            vec2 uv = UVS[is_middle ? i : edge];
            shading_normal[gl_InvocationID] = displace(object, place, faces.v[face].info, uv, position, normal);
        }
    }
    if (TEX_COORDS) {
        uint at = is_middle ? i : edge;
        if (DISPLACED) {
            uint own = scene.v.face_tex_coords.v[8u * face + at];
            tex_coord[gl_InvocationID] = own == NONE ? vec2(0.0) : scene.v.tex_coords.v[own];
        } else {
            PatchInfo info = faces.v[face].info;
            tex_coord[gl_InvocationID] = tree_tex_coord(scene, object, info.ptex_face, ptex_uv(info, UVS[at]));
        }
    }
    limit_position[gl_InvocationID] = position;
    limit_normal[gl_InvocationID] = normal;
    if (i == 0) {
        PatchInfo info = faces.v[face].info;
        bool is_mirrored = (object.flags & OBJECT_MIRRORED) != 0u;
        patch_words = uvec4(object.first_face + info.ptex_face, info.corner, info.flags,
                            (push.first_patch_id + face) | (is_mirrored ? PATCH_MIRRORED : 0u));
        fan_and_object = uvec2(split_edges == 0u ? NONE : 4u + uint(findLSB(split_edges)), entry.object);
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
