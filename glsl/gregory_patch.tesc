#version 460
// Gregory patches: makes their control points of the spokes around their corners (Loop et al. 2009, section 4.2) or of the cage's points
// (section 4.3), and what they share with their neighbours along each edge.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/gregory.glsl"
#include "shared/stencil.glsl"
#include "shared/entry.glsl"
#include "shared/factors.glsl"

layout(constant_id = 3) const bool CUT = false;      // each is a piece of a patch
layout(constant_id = 10) const bool TRIANGLE = false; // thirds of triangles
layout(vertices = 20) out;
layout(location = 0) in uint list_place[];
layout(location = 0) out vec3 control_point[]; // p, e+, e-, f+, f- of each corner
layout(location = 1) patch out vec4 low_factors;
layout(location = 2) patch out vec4 high_factors;
layout(location = 3) patch out vec2 inner_factors;
layout(location = 4) patch out uvec4 patch_words;
layout(location = 5) patch out uvec3 piece_place;
layout(location = 6) patch out uvec4 piece_first;
layout(location = 7) patch out uvec4 piece_last;
layout(location = 8) patch out uvec2 patch_places; // of the face, and of its object
layout(location = 9) out vec3 curve_point[];  // of parts of faces of more than four sides: four of each edge's curve; others have them
layout(location = 10) out vec3 curve_across[]; // four of the field across each edge

#include "shared/levels.glsl"

// What the patch shares along an edge: of a triangle one of its own, of other faces one of the patch.
EdgeFields shared_edge(SceneTables scene, GregoryFace face, uint edge)
{
    EdgeFields result;
    if (!TRIANGLE) {
        for (bool is_open = gregory_kind(face) == GREGORY_NGON; is_open; is_open = false) {
            result = ngon_edge(scene, face, edge);
        }
    }
    for (bool is_open = TRIANGLE || gregory_kind(face) == GREGORY_QUAD; is_open; is_open = false) {
        uint next = edge + 1u == (TRIANGLE ? 3u : 4u) ? 0u : edge + 1u;
        result = edge_fields(scene, face.limits[edge], face.first[edge], face.last[edge], face.limits[next]);
    }
    return result;
}

void main()
{
    DrawEntry entry = push.list.v[list_place[0]];
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[entry.object];
    GregoryFace face = scene.v.gregory.v[entry.place];
    uint i = gl_InvocationID;
    vec3 point = vec3(0.0);
    vec3 on_curve = vec3(0.0);
    vec3 across = vec3(0.0);
    bool is_stencil = has_stencil(scene, entry.place);
    if (STENCIL) {
        for (bool is_open = is_stencil; is_open; is_open = false) {
            stencil_point(scene, face, entry.place, i, TRIANGLE ? 3u : 4u, point, across);
        }
    }
    if (!TRIANGLE) {
        for (bool is_open = gregory_kind(face) == GREGORY_NGON; is_open; is_open = false) {
            point = ngon_point(scene, face, i);
        }
    }
    for (bool is_open = !is_stencil && (TRIANGLE ? i < 15u : gregory_kind(face) == GREGORY_QUAD); is_open; is_open = false) {
        point = corner_point(scene, face, i, TRIANGLE ? 3u : 4u);
    }
    for (bool is_open = !is_stencil && i < (TRIANGLE ? 12u : 16u); is_open; is_open = false) {
        EdgeFields edge = shared_edge(scene, face, i / 4u);
        on_curve = to_world(object, edge.curve[i & 3u]);
        across = edge.across[i & 3u];
    }
    control_point[gl_InvocationID] = to_world(object, point);
    curve_point[gl_InvocationID] = on_curve;
    curve_across[gl_InvocationID] = to_world_vector(object, across);
    if (i != 0u) {
        return;
    }
    PatchInfo info = scene.v.irregular.v[entry.place].info;
    // The thirds of a triangle are one patch, whose number is that of the first.
    uint number = push.first_patch_id + entry.place - (TRIANGLE ? gregory_part(face) : 0u);
    patch_words = uvec4(object.first_face + info.ptex_face, info.corner, info.flags,
                        number | ((object.flags & OBJECT_MIRRORED) != 0u ? PATCH_MIRRORED : 0u));
    patch_places = uvec2(entry.place, entry.object);
    set_factors(entry_factors(entry), entry.flags);
}
