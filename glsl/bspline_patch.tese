#version 460
// variants: lean=LEAN layers=LAYERS dump=DUMP
// Regular and transition patches: evaluates the bicubic B-spline (FAS section 5.1).
#extension GL_GOOGLE_include_directive : require
#include "shared/spacing.glsl"
#include "shared/bspline.glsl"
#include "shared/crease.glsl"
#include "shared/surface.glsl"

layout(constant_id = 1) const bool TRANSITION = false;
layout(constant_id = 2) const bool CREASE = false; // some patches have a semi-sharp crease
layout(constant_id = 3) const bool CUT = false;    // each is a piece of a patch
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
    precise vec4 nu;
    precise vec4 du;
    precise vec4 nv;
    precise vec4 dv;
    cubic_basis(u.t, u.s, nu, du);
    cubic_basis(v.t, v.s, nv, dv);
    if (CREASE && patch_sharpness > 0.0) {
        uint crease = patch_crease(PatchInfo(patch_words.x, patch_words.y, patch_words.z));
        switch (crease) {
        case 1: crease_basis(v.t, patch_sharpness, nv, dv); break;
        case 2: reversed_crease_basis(u.s, patch_sharpness, nu, du); break;
        case 4: reversed_crease_basis(v.s, patch_sharpness, nv, dv); break;
        case 8: crease_basis(u.t, patch_sharpness, nu, du); break;
        }
    }
    precise vec3 column[4];
    precise vec3 slope[4];
    for (int i = 0; i < 4; ++i) {
        column[i] = weigh(control_point[i], control_point[4 + i], control_point[8 + i], control_point[12 + i], nv);
        slope[i] = weigh(control_point[i], control_point[4 + i], control_point[8 + i], control_point[12 + i], dv);
    }
    precise vec3 position = weigh(column[0], column[1], column[2], column[3], nu) / 36.0;
    precise vec3 along_u = weigh(column[0], column[1], column[2], column[3], du);
    precise vec3 along_v = weigh(slope[0], slope[1], slope[2], slope[3], nu);
    vec3 normal = unit_normal(along_u, along_v);
    PatchInfo info = PatchInfo(patch_words.x, patch_words.y, patch_words.z);
    // -2 stands for a factor of 1 beside edges with more segments.
    float factor = CUT ? -max(inner_factors.x, inner_factors.y) * float(piece_place.z) : max(max(inner_factors.x, inner_factors.y), 1.0);
    put_surface_point(position, normal, vec2(u.t, v.t), info, patch_words.w,
                      patch_transition(info) != 0u ? KIND_TRANSITION : KIND_REGULAR, factor);
}
