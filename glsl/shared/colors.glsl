// Colours of points: subdivided by the rules of positions, which the CPU has done (crates/render/src/colors.rs), or bilinear in every
// Ptex face; white where a mesh has none.
#ifndef PLANISH_COLORS
#define PLANISH_COLORS
#include "density.glsl"

// At (u, v) of a Ptex face, between the colours at its corners.
vec3 varying_color(SceneTables scene, Object object, uint ptex_face, vec2 uv)
{
    uvec4 slots = corner_slots(scene, object, ptex_face);
    bool is_part = (slots.z & PART_OF_FACE) != 0u;
    slots.z &= ~PART_OF_FACE;
    vec3 at[4];
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        at[i] = scene.v.slot_colors.v[object.first_mesh_slot + slots[i]];
    }
    if (is_part) {
        at[1] = 0.5 * (at[0] + at[1]);
        at[3] = 0.5 * (at[0] + at[3]);
    }
    vec2 rest = 1.0 - uv;
    return rest.y * (rest.x * at[0] + uv.x * at[1]) + uv.y * (rest.x * at[3] + uv.x * at[2]);
}

// Of a limit point, which is at (u, v) of a Ptex face.
vec3 limit_color(SceneTables scene, Object object, uint limit, uint ptex_face, vec2 uv)
{
    vec3 result = vec3(1.0);
    for (bool is_open = (object.flags & OBJECT_VERTEX_COLORS) != 0u; is_open; is_open = false) {
        result = scene.v.limit_colors.v[limit];
    }
    for (bool is_open = (object.flags & OBJECT_VARYING_COLORS) != 0u; is_open; is_open = false) {
        result = varying_color(scene, object, ptex_face, uv);
    }
    return result;
}
#endif
