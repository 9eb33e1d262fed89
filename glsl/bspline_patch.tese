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
layout(quads, equal_spacing, ccw) in;
layout(location = 0) in vec3 control_point[];
layout(location = 1) patch in vec4 low_factors;
layout(location = 2) patch in vec4 high_factors;
layout(location = 3) patch in float inner_factor;
layout(location = 4) patch in uvec4 patch_words;
layout(location = 5) patch in float patch_sharpness;

Parameter parameter(float x, float low, float high)
{
    return edge_parameter(x, low, TRANSITION ? high : 0.0);
}

void main()
{
    vec2 x = gl_TessCoord.xy;
    // A point inside lies on the inner grid; one on an edge has that edge's own points.
    Parameter u;
    Parameter v;
    if (x.y == 0.0) {
        u = parameter(x.x, low_factors[0], high_factors[0]);
    } else if (x.y == 1.0) {
        u = parameter(x.x, low_factors[2], high_factors[2]);
    } else {
        u = parameter(x.x, inner_factor, 0.0);
    }
    if (x.x == 0.0) {
        u.t = 0.0;
        u.s = 1.0;
        v = parameter(x.y, low_factors[3], high_factors[3]);
    } else if (x.x == 1.0) {
        u.t = 1.0;
        u.s = 0.0;
        v = parameter(x.y, low_factors[1], high_factors[1]);
    } else {
        v = parameter(x.y, inner_factor, 0.0);
    }
    if (x.y == 0.0) {
        v.t = 0.0;
        v.s = 1.0;
    } else if (x.y == 1.0) {
        v.t = 1.0;
        v.s = 0.0;
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
    put_surface_point(position, normal, vec2(u.t, v.t), PatchInfo(patch_words.x, patch_words.y, patch_words.z), patch_words.w,
                      TRANSITION ? KIND_TRANSITION : KIND_REGULAR);
}
