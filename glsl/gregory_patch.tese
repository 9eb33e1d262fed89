#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS dump=DUMP
// Gregory patches: quads of 20 points and triangles of 15, in their Bezier form (Loop et al. 2009, sections 3.1 and 4.4). A triangle
// is drawn as three quads, the Ptex faces of its corners.
#extension GL_GOOGLE_include_directive : require
#include "shared/gregory.glsl"
#include "shared/seams.glsl"
#include "shared/tex_tree.glsl"
#include "shared/colors.glsl"
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
#include "shared/gregory_displacement.glsl"

struct Evaluated {
    vec3 position;
    vec3 along_u; // tangents; of a triangle towards corner 0 and corner 1, away from corner 2
    vec3 along_v;
};

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

// Barycentric coordinates of a point of a third of a triangle, which is bilinear between its corner, the middle of the next edge, the
// centre and the middle of the edge before. Both thirds at a line inside get the same bits.
precise vec3 barycentric(uint part, Parameter u, Parameter v)
{
    precise float next = 0.5 * (u.t * v.s);
    precise float previous = 0.5 * (u.s * v.t);
    precise float centre = (u.t * v.t) / 3.0;
    precise float own = (u.s * v.s + (next + previous)) + centre;
    precise float to_next = next + centre;
    precise float to_previous = previous + centre;
    precise vec3 result = part == 0u ? vec3(own, to_next, to_previous)
                                     : (part == 1u ? vec3(to_previous, own, to_next) : vec3(to_next, to_previous, own));
    return result;
}

// What a corner of a triangle adds: to the position, and to its derivatives by the coordinates of the corner, of the next one and of
// the one before. All thirds add the same, whichever pipeline draws them.
struct CornerTerms {
    vec3 position;
    vec3 by_own;
    vec3 by_next;
    vec3 by_previous;
};

// a, b and c are those coordinates; p, near and far control points along the next edge, plus and minus the face points.
CornerTerms corner_terms(float a, float b, float c, vec3 p, vec3 near, vec3 far, vec3 plus, vec3 minus)
{
    precise vec3 inner = blend(b, plus, c, minus);
    precise float both = 3.0 * ((a * b) * (a + b));
    precise float product = 12.0 * ((a * a) * (b * c));
    precise vec3 position = ((a * a) * a) * p + (both * (a * near + b * far) + product * inner);
    precise vec3 by_own = (3.0 * (a * a)) * p
        + (((9.0 * a + 6.0 * b) * (a * b)) * near + ((3.0 * b + 6.0 * a) * (b * b)) * far + (24.0 * ((a * b) * c)) * inner);
    precise vec3 next = ((3.0 * a + 6.0 * b) * (a * a)) * near + ((9.0 * b + 6.0 * a) * (a * b)) * far + (12.0 * ((a * a) * c)) * inner;
    precise vec3 previous = (12.0 * ((a * a) * b)) * inner;
    precise vec3 exact_next = next + product * blend_slope(b, plus, c, minus);
    precise vec3 exact_previous = previous + product * blend_slope(c, minus, b, plus);
    return CornerTerms(position, by_own, EXACT_NORMALS ? exact_next : next, EXACT_NORMALS ? exact_previous : previous);
}

precise vec3 sum_of(vec3 a, vec3 b, vec3 c)
{
    precise vec3 result = (a + b) + c;
    return result;
}

precise vec3 difference(vec3 a, vec3 b)
{
    precise vec3 result = a - b;
    return result;
}

Evaluated evaluate_triangle(vec3 at)
{
    CornerTerms terms[3];
    [[unroll]] for (int i = 0; i < 3; ++i) {
        const int next = (i + 1) % 3;
        terms[i] = corner_terms(at[i], at[next], at[(i + 2) % 3], control_point[5 * i], control_point[5 * i + 1],
                                control_point[5 * next + 2], control_point[5 * i + 3], control_point[5 * i + 4]);
    }
    vec3 by_0 = sum_of(terms[0].by_own, terms[2].by_next, terms[1].by_previous);
    vec3 by_1 = sum_of(terms[1].by_own, terms[0].by_next, terms[2].by_previous);
    vec3 by_2 = sum_of(terms[2].by_own, terms[1].by_next, terms[0].by_previous);
    Evaluated result;
    result.position = sum_of(terms[0].position, terms[1].position, terms[2].position);
    result.along_u = difference(by_0, by_2);
    result.along_v = difference(by_1, by_2);
    return result;
}

// The half of an edge at its first end, or at the other, as spacing.glsl has the points of an edge of two halves.
Parameter in_half(Parameter along, bool is_second)
{
    precise float near = 0.5 * along.t;
    precise float far = 0.5 + 0.5 * along.s;
    precise float beyond = 0.5 + 0.5 * along.t;
    precise float rest = 0.5 * along.s;
    return is_second ? Parameter(beyond, rest) : Parameter(near, far);
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

// Makes a point on edges what both sides have there. The bicubic patch across an edge decides, else the two patches have the same curve
// and the same field across it. `border_normal` becomes that patch's.
void share_point(Seam seam, Parameter u, Parameter v, inout vec3 position, inout vec3 normal, out vec3 border_normal)
{
    border_normal = normal;
    for (bool is_open = seam.edge != NONE && seam.limit == NONE; is_open; is_open = false) {
        vec3 shared_normal;
        bool is_whole = TRIANGLE || gregory_kind(push.frame.v.scene.v.gregory.v[patch_places.x]) != GREGORY_NGON;
        evaluate_edge(edge_at(seam.edge, is_whole), seam.at, position, shared_normal);
        normal = seam.is_sharp ? normal : shared_normal;
    }
    for (bool is_open = seam.border != NONE && seam.limit == NONE; is_open; is_open = false) {
        BorderPoint border = border_point(seam.border, (seam.edge & 1u) == 0u ? u : v);
        if (!seam.is_sharp || DISPLACED) {
            vec3 p[16];
            border_points(border, p);
            vec4 nu;
            vec4 du;
            vec4 nv;
            vec4 dv;
            cubic_basis(border.u.t, border.u.s, nu, du);
            cubic_basis(border.v.t, border.v.s, nv, dv);
            vec3 along_u;
            vec3 along_v;
            weigh_patch_and_tangents(p, nu, du, nv, dv, position, along_u, along_v);
            position = over_36(position);
            border_normal = without_sign_of_zero(unit_normal(along_u, along_v));
            normal = seam.is_sharp ? normal : border_normal;
        }
        if (seam.is_sharp) {
            vec3 q[4];
            border_curve(border, q);
            position = curve_position(q, border_weights(border));
        }
    }
    for (bool is_open = seam.limit != NONE; is_open; is_open = false) {
        SceneTables scene = push.frame.v.scene;
        Object object = scene.v.objects.v[patch_places.y];
        LimitPoint point = scene.v.limits.v[seam.limit];
        position = to_world(object, point.position);
        normal = normal_to_world(object, point.normal);
    }
    position = without_sign_of_zero(position);
    normal = without_sign_of_zero(normal);
}

// The tangents of a triangle along u and v of one of its thirds.
void tangents_of_part(uint part, Parameter u, Parameter v, inout vec3 along_u, inout vec3 along_v)
{
    // How the coordinates of the part's own corner and of the next one change; the three sum to 1.
    vec2 own = vec2(-0.5 * v.s - v.t / 6.0, -0.5 * u.s - u.t / 6.0);
    vec2 next = vec2(0.5 * v.s + v.t / 3.0, -u.t / 6.0);
    vec2 previous = -own - next;
    vec2 first = part == 0u ? own : (part == 1u ? previous : next);
    vec2 second = part == 1u ? own : (part == 2u ? previous : next);
    vec3 a = along_u;
    vec3 b = along_v;
    along_u = first.x * a + second.x * b;
    along_v = first.y * a + second.y * b;
}

// The colour at a point of a patch whose control points have these colours, by the weights of its position.
vec3 quad_color(Points colors, uint first, Parameter u, Parameter v)
{
    vec4 nu;
    vec4 nv;
    vec4 slope;
    bernstein(u.t, u.s, nu, slope);
    bernstein(v.t, v.s, nv, slope);
    vec4 plus = vec4(u.t, v.t, u.s, v.s);
    vec4 minus = vec4(v.t, u.s, v.s, u.t);
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        // Weights of the corner's own end of each axis, and of the points a third away; e+ of corners 1 and 3 lies along v.
        bool is_high_u = i == 1u || i == 2u;
        bool is_high_v = i >= 2u;
        vec2 near = vec2(is_high_u ? nu.w : nu.x, is_high_v ? nv.w : nv.x);
        vec2 inner = vec2(is_high_u ? nu.z : nu.y, is_high_v ? nv.z : nv.y);
        bool is_turned = (i & 1u) != 0u;
        float along_u = inner.x * near.y;
        float along_v = near.x * inner.y;
        uint at = first + 5u * i;
        sum += (near.x * near.y) * colors.v[at];
        sum += (is_turned ? along_v : along_u) * colors.v[at + 1u] + (is_turned ? along_u : along_v) * colors.v[at + 2u];
        sum += (inner.x * inner.y) * blend(plus[i], colors.v[at + 3u], minus[i], colors.v[at + 4u]);
    }
    return sum;
}

vec3 triangle_color(Points colors, uint first, vec3 at)
{
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < 3u; ++i) {
        uint next = i == 2u ? 0u : i + 1u;
        float a = at[i];
        float b = at[next];
        float c = at[3u - i - next];
        vec3 inner = blend(b, colors.v[first + 5u * i + 3u], c, colors.v[first + 5u * i + 4u]);
        vec3 on_edge = a * colors.v[first + 5u * i + 1u] + b * colors.v[first + 5u * next + 2u];
        sum += (a * a * a) * colors.v[first + 5u * i] + (3.0 * a * b * (a + b)) * on_edge + (12.0 * a * a * b * c) * inner;
    }
    return sum;
}

vec3 point_color(Parameter u, Parameter v, PatchInfo info)
{
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[patch_places.y];
    vec3 result = vec3(1.0);
    for (bool is_open = (object.flags & OBJECT_VERTEX_COLORS) != 0u; is_open; is_open = false) {
        uint first = 20u * patch_places.x;
        if (TRIANGLE) {
            uint part = gregory_part(scene.v.gregory.v[patch_places.x]);
            result = triangle_color(scene.v.gregory_colors, first, barycentric(part, u, v));
        } else {
            result = quad_color(scene.v.gregory_colors, first, u, v);
        }
    }
    for (bool is_open = (object.flags & OBJECT_VARYING_COLORS) != 0u; is_open; is_open = false) {
        result = varying_color(scene, object, info.ptex_face - object.first_face, ptex_uv(info, vec2(u.t, v.t)));
    }
    return result;
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
    if (DISPLACED) {
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
    }
    vec2 st = vec2(0.0);
    if (TEX_COORDS) {
        SceneTables scene = push.frame.v.scene;
        Object object = scene.v.objects.v[patch_places.y];
        st = tree_tex_coord(scene, object, info.ptex_face - object.first_face, ptex_uv(info, vec2(u.t, v.t)));
    }
    // A triangle is a patch of the level that its face is of; its thirds have the factors of the next.
    info.flags -= TRIANGLE ? 1u << 5 : 0u;
    put_surface_point(position, normal, shading_normal, vec2(u.t, v.t), st, info, patch_words.w,
                      TRIANGLE ? KIND_GREGORY_TRIANGLE : KIND_GREGORY_QUAD, shown_factor());
    if (COLORED) {
        put_color(point_color(u, v, info));
    }
}
