// Evaluation of ACC and Pm-patches: what both have in common. Included where the inputs of the evaluation shaders are declared.
#ifndef PLANISH_RIVAL_SURFACE
#define PLANISH_RIVAL_SURFACE
#include "gregory_seams.glsl"

// The edge of the patch that a point on edges lies on.
Seam seam_at(GregoryFace face, bvec4 is_on, Parameter u, Parameter v)
{
    uint edge = is_on.x ? 0u : (is_on.w ? 3u : (is_on.y ? 1u : 2u));
    Parameter at = edge == 0u ? u : (edge == 1u ? v : (edge == 2u ? turned(u) : turned(v)));
    uint corner = is_on.x && is_on.w ? 0u : (is_on.x && is_on.y ? 1u : (is_on.y && is_on.z ? 2u : (is_on.z && is_on.w ? 3u : NONE)));
    return Seam(edge, at, edge, true, false, corner == NONE ? NONE : face.limits[min(corner, 3u)], face.borders[edge]);
}

// Makes a point on edges what both sides have there: `curve` is that of the edge, `along` its tangent in Bezier form, over 3.
void share_point(Seam seam, vec3 curve[4], vec3 along[3], Parameter u, Parameter v, inout vec3 position, inout vec3 normal)
{
    vec3 across[4];
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        across[i] = edge_across[4u * min(seam.edge, 3u) + i];
    }
    precise vec4 n;
    precise vec4 d;
    bernstein(seam.at.t, seam.at.s, n, d);
    position = weigh_ends(curve[0], curve[1], curve[2], curve[3], n);
    normal = edge_normal(along[0], along[1], along[2], across, seam.at);
    vec3 border_normal = normal;
    share_border(seam, u, v, position, normal, border_normal);
    share_corner(seam.limit, position, normal);
    position = without_sign_of_zero(position);
    normal = without_sign_of_zero(normal);
}

void put_point(Parameter u, Parameter v, vec3 position, vec3 normal)
{
    PatchInfo info = PatchInfo(patch_words.x, patch_words.y, patch_words.z);
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[patch_places.y];
    uint ptex_face = info.ptex_face - object.first_face;
    vec2 st = vec2(0.0);
#if defined(SHADING) || defined(DUMP) || defined(COLORS)
    if (TEX_COORDS) {
        st = tree_tex_coord(scene, object, ptex_face, ptex_uv(info, vec2(u.t, v.t)));
    }
#endif
    put_surface_point(position, normal, normal, vec2(u.t, v.t), st, info, patch_words.w, KIND_GREGORY_QUAD, shown_factor());
    put_object(patch_places.y);
#if defined(COLORS) || defined(SHADING) || defined(DUMP)
    if (COLORED) {
        for (bool is_open = (object.flags & OBJECT_VARYING_COLORS) != 0u; is_open; is_open = false) {
            put_color(varying_color(scene, object, ptex_face, ptex_uv(info, vec2(u.t, v.t))));
        }
    }
#endif
    if (MOVING) {
        put_next_position(moved_on(object, position));
    }
}
#endif
