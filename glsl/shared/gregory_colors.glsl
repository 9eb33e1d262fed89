// Colours of vertices on Gregory patches. Included where `patch_places` and `push` are declared.
#ifndef PLANISH_GREGORY_COLORS
#define PLANISH_GREGORY_COLORS
#include "colors.glsl"
#include "gregory.glsl"
#include "gregory_triangle.glsl"

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
#endif
