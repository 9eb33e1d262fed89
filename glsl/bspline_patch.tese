#version 460
// variants: lean=LEAN layers=LAYERS dump=DUMP
// Regular and transition patches: evaluates the bicubic B-spline (FAS section 5.1).
#extension GL_GOOGLE_include_directive : require
#include "shared/spacing.glsl"
#include "shared/bspline.glsl"
#include "shared/crease.glsl"
#include "shared/seams.glsl"
#include "shared/surface.glsl"

layout(constant_id = 1) const bool TRANSITION = false;
layout(constant_id = 2) const bool CREASE = false; // some patches have a semi-sharp crease
layout(constant_id = 3) const bool CUT = false;    // each is a piece of a patch
// Whether seams have the same bits on both sides.
layout(constant_id = 5) const bool WATERTIGHT = true;
layout(quads, equal_spacing, ccw) in;
layout(location = 0) in vec3 control_point[];
layout(location = 1) patch in vec4 low_factors;
layout(location = 2) patch in vec4 high_factors;
layout(location = 3) patch in vec2 inner_factors;
layout(location = 4) patch in uvec4 patch_words;
layout(location = 5) patch in float patch_sharpness;
layout(location = 6) patch in uvec3 piece_place;
layout(location = 7) patch in uvec4 piece_first;
layout(location = 8) patch in uvec4 piece_last;
layout(location = 9) patch in uvec2 patch_places; // of its seams, or NONE; of its object

void basis(Parameter u, Parameter v, uint crease, float sharpness, out precise vec4 nu, out precise vec4 du,
           out precise vec4 nv, out precise vec4 dv)
{
    cubic_basis(u.t, u.s, nu, du);
    cubic_basis(v.t, v.s, nv, dv);
    if (CREASE && sharpness > 0.0) {
        switch (crease) {
        case 1: crease_basis(v.t, sharpness, nv, dv); break;
        case 2: reversed_crease_basis(u.s, sharpness, nu, du); break;
        case 4: reversed_crease_basis(v.s, sharpness, nv, dv); break;
        case 8: crease_basis(u.t, sharpness, nu, du); break;
        }
    }
}

struct Evaluated {
    vec3 position;
    vec3 normal;
};

precise vec3 patch_position(vec3 p[16], vec4 nu, vec4 nv)
{
    precise vec3 result = weigh_patch(p, nu, nv) / 36.0;
    return result;
}

precise vec3 curve_position(vec3 p[4], vec4 n)
{
    precise vec3 result = weigh(p[0], p[1], p[2], p[3], n) / 6.0;
    return result;
}

// Where all terms of a sum are 0 its sign depends on what was added: not any more.
precise vec3 without_sign_of_zero(vec3 a)
{
    precise vec3 result = a + 0.0;
    return result;
}

// Evaluates so that every patch at an edge or a corner gets the same bits.
Evaluated evaluate_watertight(Parameter u, Parameter v, bvec4 is_on, PatchInfo info)
{
    vec3 p[16];
    [[unroll]] for (int i = 0; i < 16; ++i) {
        p[i] = control_point[i];
    }
    uint boundary = patch_boundary(info);
    uint crease = patch_crease(info);
    float sharpness = patch_sharpness;
    // The edge of a coarser patch that this point lies on, and the point's place there.
    BorderPoint coarse;
    coarse.place = NONE;
    uint limit = NONE;
    uint border_edge = NO_EDGE;
    // Loops, not branches: a software driver runs the body of a branch that no thread takes, but not that of a loop.
    for (bool is_open = patch_places.x != NONE && any(is_on); is_open; is_open = false) {
        SeamTable seams = push.frame.v.scene.v.seams;
        uint border = NONE;
        [[dont_unroll]] for (uint edge = 0u; edge < 4u; ++edge) {
            uint found = is_on[edge] ? seams.v[patch_places.x].borders[edge] : NONE;
            if (found != NONE) {
                border = found;
                border_edge = edge;
            }
            // Corner i lies between edge i - 1 and edge i.
            if (is_on[edge] && is_on[(edge + 3u) & 3u]) {
                limit = seams.v[patch_places.x].limits[edge];
            }
        }
        if (border != NONE && limit == NONE) {
            coarse = border_point(border, (border_edge & 1u) == 0u ? u : v);
        }
    }
    bool is_sharp_border = coarse.place != NONE && (boundary >> border_edge & 1u) != 0u;
    for (bool is_open = coarse.place != NONE && !is_sharp_border; is_open; is_open = false) {
        Object object = push.frame.v.scene.v.objects.v[patch_places.y];
        PatchInfo info = push.patches.v[coarse.place].info;
        [[dont_unroll]] for (uint i = 0u; i < 16u; ++i) {
            p[i] = vec3(0.0);
            if (is_beside(coarse.edge, i)) {
                p[i] = to_world(object, control_point_of(push.patches, push.points, coarse.place, i, patch_boundary(info)));
            }
        }
        if (CREASE) {
            crease = patch_crease(info);
            sharpness = push.patches.v[coarse.place].sharpness;
        }
        u = coarse.u;
        v = coarse.v;
    }
    vec4 nu;
    vec4 du;
    vec4 nv;
    vec4 dv;
    basis(u, v, crease, sharpness, nu, du, nv, dv);
    vec3 position = patch_position(p, nu, nv);
    vec3 normal = unit_normal(weigh_patch(p, du, nv), weigh_patch(p, nu, dv));
    // On a boundary or an infinite crease the surface is the curve of the points along it, whatever lies beside.
    uint sharp_edges = 0u;
    [[unroll]] for (uint edge = 0u; edge < 4u; ++edge) {
        sharp_edges |= is_on[edge] ? boundary & 1u << edge : 0u;
    }
    for (bool is_open = sharp_edges != 0u; is_open; is_open = false) {
        uint edge = uint(findLSB(sharp_edges));
        vec3 q[4];
        vec4 n = (edge & 1u) == 0u ? nu : nv;
        if (is_sharp_border) {
            Object object = push.frame.v.scene.v.objects.v[patch_places.y];
            uint coarse_boundary = patch_boundary(push.patches.v[coarse.place].info);
            [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
                q[i] = to_world(object, control_point_of(push.patches, push.points, coarse.place,
                                                         along_edge(coarse.edge, i), coarse_boundary));
            }
            Parameter along = (coarse.edge & 1u) == 0u ? coarse.u : coarse.v;
            vec4 slope;
            cubic_basis(along.t, along.s, n, slope);
        } else {
            [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
                q[i] = control_point[along_edge(edge, i)];
            }
        }
        position = curve_position(q, n);
        // Two of them meet in a corner that is interpolated.
        uint rest = sharp_edges & (sharp_edges - 1u);
        if (rest != 0u) {
            uint other = uint(findLSB(rest));
            // Corner 0 lies between edges 3 and 0; else the higher edge begins there.
            uint corner = edge == 0u && other == 3u ? 0u : other;
            const uint PLACES[4] = uint[4](5u, 6u, 10u, 9u);
            position = control_point[PLACES[corner]];
        }
    }
    position = without_sign_of_zero(position);
    normal = without_sign_of_zero(normal);
    for (bool is_open = limit != NONE; is_open; is_open = false) {
        Object object = push.frame.v.scene.v.objects.v[patch_places.y];
        LimitPoint point = push.frame.v.scene.v.limits.v[limit];
        position = to_world(object, point.position);
        normal = normal_to_world(object, point.normal);
    }
    return Evaluated(position, normal);
}

// Evaluates with fewer operations, each patch by itself.
Evaluated evaluate(Parameter u, Parameter v, PatchInfo info)
{
    precise vec4 nu;
    precise vec4 du;
    precise vec4 nv;
    precise vec4 dv;
    basis(u, v, patch_crease(info), patch_sharpness, nu, du, nv, dv);
    precise vec3 column[4];
    precise vec3 slope[4];
    for (int i = 0; i < 4; ++i) {
        column[i] = weigh(control_point[i], control_point[4 + i], control_point[8 + i], control_point[12 + i], nv);
        slope[i] = weigh(control_point[i], control_point[4 + i], control_point[8 + i], control_point[12 + i], dv);
    }
    precise vec3 position = weigh(column[0], column[1], column[2], column[3], nu) / 36.0;
    precise vec3 along_u = weigh(column[0], column[1], column[2], column[3], du);
    precise vec3 along_v = weigh(slope[0], slope[1], slope[2], slope[3], nu);
    return Evaluated(position, unit_normal(along_u, along_v));
}

// The point at x of an edge of the patch, or of the piece's part of it.
Parameter on_edge(uint edge, float x)
{
    float low = low_factors[edge];
    float high = TRANSITION ? high_factors[edge] : 0.0;
    if (!CUT) {
        return edge_parameter(x, low, high);
    }
    float first = float(piece_first[edge]);
    float last = float(piece_last[edge]);
    float i = min(first + round(x * max(last - first, 1.0)), last);
    return edge_point(i, low, high);
}

// The point at x of a row inside, along an axis.
Parameter in_row(uint axis, float x)
{
    if (!CUT) {
        return row_parameter(x, inner_factors[axis]);
    }
    float count = -inner_factors[axis];
    return even_point(float(piece_place[axis]) * count + round(x * count), float(piece_place.z) * count);
}

void main()
{
    vec2 x = gl_TessCoord.xy;
    // A point inside lies on the inner grid; one on an edge of the patch has that edge's own points.
    bvec4 is_on = bvec4(x.y == 0.0, x.x == 1.0, x.y == 1.0, x.x == 0.0);
    if (CUT) {
        uint last = piece_place.z - 1u;
        is_on = bvec4(is_on.x && piece_place.y == 0u, is_on.y && piece_place.x == last, is_on.z && piece_place.y == last,
                      is_on.w && piece_place.x == 0u);
    }
    Parameter u;
    Parameter v;
    if (is_on.x) {
        u = on_edge(0, x.x);
    } else if (is_on.z) {
        u = on_edge(2, x.x);
    } else {
        u = in_row(0, x.x);
    }
    if (is_on.w) {
        u = Parameter(0.0, 1.0);
        v = on_edge(3, x.y);
    } else if (is_on.y) {
        u = Parameter(1.0, 0.0);
        v = on_edge(1, x.y);
    } else {
        v = in_row(1, x.y);
    }
    if (is_on.x) {
        v = Parameter(0.0, 1.0);
    } else if (is_on.z) {
        v = Parameter(1.0, 0.0);
    }
    PatchInfo info = PatchInfo(patch_words.x, patch_words.y, patch_words.z);
    Evaluated point;
    if (WATERTIGHT) {
        point = evaluate_watertight(u, v, is_on, info);
    } else {
        point = evaluate(u, v, info);
    }
    // -2 stands for a factor of 1 beside edges with more segments.
    float factor = CUT ? -max(inner_factors.x, inner_factors.y) * float(piece_place.z) : max(max(inner_factors.x, inner_factors.y), 1.0);
    put_surface_point(point.position, point.normal, vec2(u.t, v.t), info, patch_words.w,
                      patch_transition(info) != 0u ? KIND_TRANSITION : KIND_REGULAR, factor);
}
