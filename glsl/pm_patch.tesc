#version 460
// Pm-patches of quads (Myles, Ni and Peters 2008): makes their 24 coefficients, 6 a side.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/rival.glsl"
#include "shared/entry.glsl"
#include "shared/factors.glsl"

layout(constant_id = 3) const bool CUT = false; // each is a piece of a patch
layout(vertices = 24) out;
layout(location = 0) in uint list_place[];
layout(location = 0) out vec3 control_point[]; // of each side p, the curve's inner two, two beside them, one towards the middle
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

float sine_of(float cosine)
{
    precise float result = sqrt(1.0 - cosine * cosine);
    return result;
}

float sum_of_sines(GregoryFace face, uint side)
{
    precise float result = sine_of(face.cosines[side]) + sine_of(face.cosines[(side + 1u) & 3u]);
    return result;
}

// Beside the inner point `near` of a curve from p to q whose other one is `far`; `r` points into the face, `c` is the cosine at p.
precise vec3 beside_curve(vec3 p, vec3 near, vec3 far, vec3 r, float c, float far_c, float sines)
{
    precise vec3 raised = 0.25 * p + 0.75 * near;
    precise vec3 offset = ((0.25 * (1.0 + c)) * (far - near) + ((1.0 - far_c) / 8.0) * (near - p)) + (0.25 / sines) * r;
    precise vec3 result = raised + offset;
    return result;
}

vec3 beside_first(SceneTables scene, GregoryFace face, uint side)
{
    SpokePoint from = spoke_out(scene, face, side);
    return beside_curve(corner_position(scene, face, side), from.edge, spoke_into(scene, face, side).edge, from.beside, face.cosines[side],
                        face.cosines[(side + 1u) & 3u], sum_of_sines(face, side));
}

vec3 beside_last(SceneTables scene, GregoryFace face, uint side)
{
    SpokePoint to = spoke_into(scene, face, side);
    return beside_curve(corner_position(scene, face, side + 1u), to.edge, spoke_out(scene, face, side).edge, -to.beside,
                        face.cosines[(side + 1u) & 3u], face.cosines[side], sum_of_sines(face, side));
}

// The middle of the bicubic patch of the inner points.
precise vec3 middle_of_face(SceneTables scene, GregoryFace face)
{
    precise vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        precise vec3 ends = middle_out(scene, face, i) + middle_into(scene, face, i);
        sum = sum + ((corner_position(scene, face, i) + 9.0 * inner_point(scene, face, i)) + 3.0 * ends);
    }
    return sum / 64.0;
}

precise vec3 towards_middle(SceneTables scene, GregoryFace face, uint side)
{
    const float WEIGHTS[4] = float[4](3.0, 1.0, -1.0, -3.0);
    precise vec3 tilt = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        uint own = (side + i) & 3u;
        precise vec3 difference = beside_first(scene, face, own) - beside_last(scene, face, (own + 1u) & 3u);
        tilt = tilt + (WEIGHTS[i] / 16.0) * difference;
    }
    precise vec3 result = middle_of_face(scene, face) + tilt;
    return result;
}

vec3 point_of_side(SceneTables scene, GregoryFace face, uint side, uint which)
{
    vec3 result = vec3(0.0);
    // Loops, not branches: a software driver runs the body of a branch that no thread takes, but not that of a loop.
    for (bool is_open = which == 0u; is_open; is_open = false) {
        result = corner_position(scene, face, side);
    }
    for (bool is_open = which == 1u; is_open; is_open = false) {
        result = spoke_out(scene, face, side).edge;
    }
    for (bool is_open = which == 2u; is_open; is_open = false) {
        result = spoke_into(scene, face, side).edge;
    }
    for (bool is_open = which == 3u; is_open; is_open = false) {
        result = beside_first(scene, face, side);
    }
    for (bool is_open = which == 4u; is_open; is_open = false) {
        result = beside_last(scene, face, side);
    }
    for (bool is_open = which == 5u; is_open; is_open = false) {
        result = towards_middle(scene, face, side);
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
    vec3 across = vec3(0.0);
    for (bool is_open = i < 16u; is_open; is_open = false) {
        across = to_world_vector(object, across_edge(scene, face, i / 4u, i & 3u, 2.0 / sum_of_sines(face, i / 4u)));
    }
    control_point[gl_InvocationID] = to_world(object, point_of_side(scene, face, i / 6u, i % 6u));
    edge_across[gl_InvocationID] = across;
    if (i == 0u) {
        put_patch(scene, object, entry);
    }
}
