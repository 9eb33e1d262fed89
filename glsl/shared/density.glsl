// Density of tessellation: a number at each vertex of the cage, carried to finer vertices by linear interpolation, which is
// bilinear in a Ptex face. CPU twin: crates/subdiv/src/selection.rs, the same operations in the same order.
//
// On an edge between Ptex faces both sides interpolate between its two ends alone, whichever way round: the bits are the same.
#ifndef PLANISH_DENSITY
#define PLANISH_DENSITY
#include "scene.glsl"

// Densities at the corners of a Ptex face. Of a part of a face of other than four sides those at its vertex, the next one, the
// middle of the face, and the previous one.
struct FaceDensity {
    vec4 at;
    bool is_part;
};

uvec4 corner_slots(SceneTables scene, Object object, uint ptex_face)
{
    return scene.v.ptex_faces.v[object.first_ptex + ptex_face];
}

FaceDensity face_density(SceneTables scene, Object object, uint ptex_face)
{
    uvec4 slots = corner_slots(scene, object, ptex_face);
    FaceDensity result;
    result.is_part = (slots.z & PART_OF_FACE) != 0u;
    slots.z &= ~PART_OF_FACE;
    for (int corner = 0; corner < 4; ++corner) {
        result.at[corner] = scene.v.densities.v[object.first_slot + slots[corner]].density;
    }
    return result;
}

precise float linear(float a, float b, float t)
{
    precise float s = 1.0 - t;
    precise float result = s * a + t * b;
    return result;
}

// `uv` is dyadic: all its products with halves are exact.
float density_at(FaceDensity face, vec2 uv)
{
    vec4 d = face.at;
    if (face.is_part) {
        if (uv.y == 0.0) {
            return linear(d.x, d.y, 0.5 * uv.x);
        }
        if (uv.x == 0.0) {
            return linear(d.x, d.w, 0.5 * uv.y);
        }
        precise float next = 0.5 * (d.x + d.y);
        precise float previous = 0.5 * (d.x + d.w);
        d.y = next;
        d.w = previous;
    }
    return linear(linear(d.x, d.y, uv.x), linear(d.w, d.z, uv.x), uv.y);
}

// Corner i of a square: (0,0), (1,0), (1,1), (0,1).
vec2 square_corner(uint i)
{
    return vec2(i == 1u || i == 2u, i >= 2u);
}

vec4 corner_densities(FaceDensity face, PatchInfo info)
{
    vec4 result;
    [[dont_unroll]] for (uint corner = 0; corner < 4; ++corner) {
        result[corner] = density_at(face, ptex_uv(info, square_corner(corner)));
    }
    return result;
}
#endif
