#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING dump=DUMP lean_maps=LEAN,MAPS layers_maps=LAYERS,MAPS colors_maps=LAYERS,COLORS,MAPS shading_maps=SHADING,MAPS dump_maps=DUMP,MAPS
// Gregory patches: quads of 20 points and triangles of 15, in their Bezier form (Loop et al. 2009, sections 3.1 and 4.4). A triangle
// is drawn as three quads, the Ptex faces of its corners.
#extension GL_GOOGLE_include_directive : require
#include "shared/gregory.glsl"
#include "shared/seams.glsl"
#include "shared/tex_tree.glsl"
#include "shared/colors.glsl"
#include "shared/motion.glsl"
#include "shared/surface.glsl"

layout(constant_id = 3) const bool CUT = false;        // each is a piece of a patch
layout(constant_id = 10) const bool TRIANGLE = false;   // thirds of triangles
layout(constant_id = 11) const bool EXACT_NORMALS = false; // of the rational patch, instead of those of its Bezier form
const bool TRANSITION = true; // edges may be split
// Whether seams have the same bits on both sides.
layout(constant_id = 5) const bool WATERTIGHT = true;
layout(quads, equal_spacing, ccw) in;
layout(location = 0) in vec3 control_point[];
layout(location = 1) patch in vec4 low_factors;
layout(location = 2) patch in vec4 high_factors;
layout(location = 3) patch in vec2 inner_factors;
layout(location = 4) patch in uvec4 patch_words;
layout(location = 5) patch in uvec3 piece_place;
layout(location = 6) patch in uvec4 piece_first;
layout(location = 7) patch in uvec4 piece_last;
layout(location = 8) patch in uvec2 patch_places; // of the face, and of its object
layout(location = 9) in vec3 curve_point[];
layout(location = 10) in vec3 curve_across[];
#include "shared/domain.glsl"
#include "shared/border.glsl"
#include "shared/gregory_seams.glsl"
#if defined(MAPS)
#include "shared/gregory_displacement.glsl"
#endif
#include "shared/gregory_triangle.glsl"
#if defined(COLORS) || defined(SHADING) || defined(DUMP)
#include "shared/gregory_colors.glsl"
#endif

Evaluated evaluate_quad(Parameter u, Parameter v)
{
    // f+ of corner i lies along the edge that begins there.
    vec4 plus = vec4(u.t, v.t, u.s, v.s);
    vec4 minus = vec4(v.t, u.s, v.s, u.t);
    vec3 inner[4];
    [[unroll]] for (int i = 0; i < 4; ++i) {
        inner[i] = blend(plus[i], control_point[5 * i + 3], minus[i], control_point[5 * i + 4]);
    }
    vec4 nu;
    vec4 du;
    vec4 nv;
    vec4 dv;
    bernstein(u.t, u.s, nu, du);
    bernstein(v.t, v.s, nv, dv);
    vec3 row[4];
    vec3 slope[4];
    row[0] = weigh_ends(control_point[0], control_point[1], control_point[7], control_point[5], nu);
    row[1] = weigh_ends(control_point[2], inner[0], inner[1], control_point[6], nu);
    row[2] = weigh_ends(control_point[16], inner[3], inner[2], control_point[12], nu);
    row[3] = weigh_ends(control_point[15], control_point[17], control_point[11], control_point[10], nu);
    slope[0] = weigh_ends(control_point[0], control_point[1], control_point[7], control_point[5], du);
    slope[1] = weigh_ends(control_point[2], inner[0], inner[1], control_point[6], du);
    slope[2] = weigh_ends(control_point[16], inner[3], inner[2], control_point[12], du);
    slope[3] = weigh_ends(control_point[15], control_point[17], control_point[11], control_point[10], du);
    Evaluated result;
    result.position = weigh_ends(row[0], row[1], row[2], row[3], nv);
    result.along_u = weigh_ends(slope[0], slope[1], slope[2], slope[3], nv);
    result.along_v = weigh_ends(row[0], row[1], row[2], row[3], dv);
    if (EXACT_NORMALS) {
        // How plus and minus change along u and v; bernstein's derivatives are a third.
        const vec2 BY_PLUS[4] = vec2[4](vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(-1.0, 0.0), vec2(0.0, -1.0));
        const vec2 BY_MINUS[4] = vec2[4](vec2(0.0, 1.0), vec2(-1.0, 0.0), vec2(0.0, -1.0), vec2(1.0, 0.0));
        vec4 weight = vec4(nu.y * nv.y, nu.z * nv.y, nu.z * nv.z, nu.y * nv.z) / 3.0;
        [[unroll]] for (int i = 0; i < 4; ++i) {
            vec3 first = blend_slope(plus[i], control_point[5 * i + 3], minus[i], control_point[5 * i + 4]);
            vec3 second = blend_slope(minus[i], control_point[5 * i + 4], plus[i], control_point[5 * i + 3]);
            result.along_u += weight[i] * (BY_PLUS[i].x * first + BY_MINUS[i].x * second);
            result.along_v += weight[i] * (BY_PLUS[i].y * first + BY_MINUS[i].y * second);
        }
    }
    return result;
}

// The limit point that a corner of the patch is, or NONE.
uint corner_limit(GregoryFace face, bvec4 is_on)
{
    uint kind = gregory_kind(face);
    uint corner = is_on.x && is_on.w ? 0u : (is_on.x && is_on.y ? 1u : (is_on.y && is_on.z ? 2u : (is_on.z && is_on.w ? 3u : NONE)));
    if (corner == NONE) {
        return NONE;
    }
    if (TRIANGLE) {
        return corner == 0u ? face.limits[gregory_part(face)] : NONE;
    }
    if (kind == GREGORY_NGON) {
        return corner == 0u ? face.limits[1] : (corner == 2u ? face.limits[3] : NONE);
    }
    return face.limits[corner];
}

// Whole patches have the curves' points among their own.
EdgeFields edge_at(uint edge, bool is_whole)
{
    // Where no edge is asked for nothing is read beyond the patch.
    edge = min(edge, 3u);
    uint next = edge + 1u == (TRIANGLE ? 3u : 4u) ? 0u : edge + 1u;
    uint of_patch[4] = uint[4](5u * edge, 5u * edge + 1u, 5u * next + 2u, 5u * next);
    EdgeFields result;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        if (is_whole) {
            result.curve[i] = control_point[of_patch[i]];
        } else {
            result.curve[i] = curve_point[4u * edge + i];
        }
        result.across[i] = curve_across[4u * edge + i];
    }
    return result;
}

// The edge that a point on edges lies on: of two the outer one first, which the neighbours know.
Seam seam_at(GregoryFace face, bvec4 is_on, Parameter u, Parameter v)
{
    bool is_part = TRIANGLE || gregory_kind(face) == GREGORY_NGON;
    uint edge = is_on.x ? 0u : (is_on.w ? 3u : (is_on.y ? 1u : 2u));
    Seam result;
    result.edge = edge;
    result.at = edge == 0u ? u : (edge == 1u ? v : (edge == 2u ? turned(u) : turned(v)));
    result.of_face = edge;
    result.is_outer = !is_part || edge == 0u || edge == 3u;
    if (is_part && result.is_outer) {
        result.at = in_half(result.at, edge == 3u);
        // Edges of the face: of a larger one from the corner before, to the corner after.
        result.of_face = edge == 0u ? 1u : 0u;
        if (TRIANGLE) {
            uint part = gregory_part(face);
            result.of_face = edge == 0u ? part : (part + 2u) % 3u;
            result.edge = result.of_face;
        }
    } else if (TRIANGLE) {
        // The triangle itself has a value there, whichever third asks.
        result.edge = NONE;
    }
    result.is_sharp = result.is_outer && gregory_is_sharp(face, result.of_face);
    result.limit = corner_limit(face, is_on);
    result.border = is_part ? NONE : face.borders[edge];
    return result;
}

// Makes a point on edges what both sides have there: two patches have the same curve and the same field across it, unless a bicubic
// patch decides. `border_normal` becomes that patch's.
void share_point(Seam seam, Parameter u, Parameter v, inout vec3 position, inout vec3 normal, out vec3 border_normal)
{
    border_normal = normal;
    for (bool is_open = seam.edge != NONE && seam.limit == NONE; is_open; is_open = false) {
        vec3 shared_normal;
        bool is_whole = TRIANGLE || gregory_kind(push.frame.v.scene.v.gregory.v[patch_places.x]) != GREGORY_NGON;
        evaluate_edge(edge_at(seam.edge, is_whole), seam.at, position, shared_normal);
        normal = seam.is_sharp ? normal : shared_normal;
    }
    share_border(seam, u, v, position, normal, border_normal);
    share_corner(seam.limit, position, normal);
    position = without_sign_of_zero(position);
    normal = without_sign_of_zero(normal);
}

void main()
{
    Parameter u;
    Parameter v;
    bvec4 is_on;
    domain_point(u, v, is_on);
    PatchInfo info = PatchInfo(patch_words.x, patch_words.y, patch_words.z);
    Evaluated point;
    if (TRIANGLE) {
        uint part = gregory_part(push.frame.v.scene.v.gregory.v[patch_places.x]);
        point = evaluate_triangle(barycentric(part, u, v));
    } else {
        point = evaluate_quad(u, v);
    }
    vec3 position = without_sign_of_zero(point.position);
    vec3 normal = without_sign_of_zero(unit_normal(point.along_u, point.along_v));
    Seam seam = Seam(NONE, u, 0u, false, false, NONE, NONE);
    vec3 border_normal = normal;
    if (WATERTIGHT) {
        for (bool is_open = any(is_on); is_open; is_open = false) {
            seam = seam_at(push.frame.v.scene.v.gregory.v[patch_places.x], is_on, u, v);
            share_point(seam, u, v, position, normal, border_normal);
        }
    }
    vec3 shading_normal = normal;
#if defined(MAPS)
    vec3 along_u = 3.0 * point.along_u;
    vec3 along_v = 3.0 * point.along_v;
    if (TRIANGLE) {
        along_u = point.along_u;
        along_v = point.along_v;
        tangents_of_part(gregory_part(push.frame.v.scene.v.gregory.v[patch_places.x]), u, v, along_u, along_v);
    }
    uint first_face = push.frame.v.scene.v.objects.v[patch_places.y].first_face;
    is_on = bvec4(WATERTIGHT && is_on.x, WATERTIGHT && is_on.y, WATERTIGHT && is_on.z, WATERTIGHT && is_on.w);
    shading_normal = displace(is_on, seam, u, v, info.ptex_face - first_face, along_u, along_v, border_normal, position, normal);
#endif
    vec2 st = vec2(0.0);
#if defined(SHADING) || defined(DUMP) || defined(COLORS)
    if (TEX_COORDS) {
        SceneTables scene = push.frame.v.scene;
        Object object = scene.v.objects.v[patch_places.y];
        st = tree_tex_coord(scene, object, info.ptex_face - object.first_face, ptex_uv(info, vec2(u.t, v.t)));
    }
#endif
    // A triangle is a patch of the level that its face is of; its thirds have the factors of the next.
    info.flags -= TRIANGLE ? 1u << 5 : 0u;
    put_surface_point(position, normal, shading_normal, vec2(u.t, v.t), st, info, patch_words.w,
                      TRIANGLE ? KIND_GREGORY_TRIANGLE : KIND_GREGORY_QUAD, shown_factor());
    put_object(patch_places.y);
#if defined(COLORS) || defined(SHADING) || defined(DUMP)
    if (COLORED) {
        put_color(point_color(u, v, info));
    }
#endif
    if (MOVING) {
        put_next_position(moved_on(push.frame.v.scene.v.objects.v[patch_places.y], position));
    }
}
