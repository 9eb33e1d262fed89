#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING dump=DUMP
// Pm-patches of quads (Myles, Ni and Peters 2008): four quartic triangles that meet in the middle.
#extension GL_GOOGLE_include_directive : require
#include "shared/gregory.glsl"
#include "shared/seams.glsl"
#include "shared/tex_tree.glsl"
#include "shared/colors.glsl"
#include "shared/motion.glsl"
#include "shared/surface.glsl"

layout(constant_id = 3) const bool CUT = false; // each is a piece of a patch
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
layout(location = 9) in vec3 edge_across[];
#include "shared/domain.glsl"
#include "shared/gregory_seams.glsl"
#include "shared/rival_surface.glsl"

// A cubic's inner point next to `corner` as a quartic's.
precise vec3 raised(vec3 corner, vec3 near)
{
    precise vec3 result = 0.25 * corner + 0.75 * near;
    return result;
}

precise vec3 mean(vec3 a, vec3 b)
{
    precise vec3 result = 0.5 * a + 0.5 * b;
    return result;
}

precise vec3 corner_mean(vec3 a, vec3 b, vec3 c, vec3 weights)
{
    precise vec3 result = (a * weights.x + b * weights.y) + c * weights.z;
    return result;
}

precise vec3 difference(vec3 a, vec3 b)
{
    precise vec3 result = a - b;
    return result;
}

// The 15 Bezier points of the triangle at a side: row by row from it to the middle.
void triangle_points(uint side, out vec3 q[15])
{
    uint own = 6u * side;
    uint next = 6u * ((side + 1u) & 3u);
    uint opposite = 6u * ((side + 2u) & 3u);
    uint previous = 6u * ((side + 3u) & 3u);
    q[0] = control_point[own];
    q[1] = raised(q[0], control_point[own + 1u]);
    q[2] = mean(control_point[own + 1u], control_point[own + 2u]);
    q[4] = control_point[next];
    q[3] = raised(q[4], control_point[own + 2u]);
    q[5] = mean(q[1], raised(q[0], control_point[previous + 2u]));
    q[6] = control_point[own + 3u];
    q[7] = control_point[own + 4u];
    q[8] = mean(q[3], raised(q[4], control_point[next + 1u]));
    q[9] = mean(q[6], control_point[previous + 4u]);
    q[10] = control_point[own + 5u];
    q[11] = mean(q[7], control_point[next + 3u]);
    q[12] = mean(q[10], control_point[previous + 5u]);
    q[13] = mean(q[10], control_point[next + 5u]);
    q[14] = mean(mean(q[10], control_point[opposite + 5u]), mean(control_point[next + 5u], control_point[previous + 5u]));
}

Evaluated evaluate(Parameter u, Parameter v)
{
    // The side whose triangle the point lies in, and the point seen from there: a along the side, b into the face.
    uint side = v.t <= u.t ? (u.t <= v.s ? 0u : 1u) : (u.t <= v.s ? 3u : 2u);
    float a = side == 0u ? u.t : (side == 1u ? v.t : (side == 2u ? u.s : v.s));
    float b = side == 0u ? v.t : (side == 1u ? u.s : (side == 2u ? v.s : u.t));
    float beyond = side == 0u ? u.s : (side == 1u ? v.s : (side == 2u ? u.t : v.t)); // 1 - a
    precise vec3 weights = vec3(beyond - b, a - b, 2.0 * b);
    vec3 q[15];
    triangle_points(side, q);
    // De Casteljau's rows lie one behind the other, of 5, 4, 3 and 2 points.
    [[unroll]] for (int size = 4; size > 1; --size) {
        int to = 0;
        int from = 0;
        [[unroll]] for (int j = 0; j < size; ++j) {
            [[unroll]] for (int i = 0; i < size - j; ++i) {
                q[to] = corner_mean(q[from + i], q[from + i + 1], q[from + size + 1 - j + i], weights);
                ++to;
            }
            from += size + 1 - j;
        }
    }
    vec3 along = difference(q[1], q[0]);
    vec3 inward = difference(difference(q[2], q[0]), difference(q[1], q[2]));
    Evaluated result;
    result.position = corner_mean(q[0], q[1], q[2], weights);
    result.along_u = side == 0u ? along : (side == 1u ? -inward : (side == 2u ? -along : inward));
    result.along_v = side == 0u ? inward : (side == 1u ? along : (side == 2u ? -inward : -along));
    return result;
}

void main()
{
    Parameter u;
    Parameter v;
    bvec4 is_on;
    domain_point(u, v, is_on);
    Evaluated point = evaluate(u, v);
    vec3 position = without_sign_of_zero(point.position);
    vec3 normal = without_sign_of_zero(unit_normal(point.along_u, point.along_v));
    if (WATERTIGHT) {
        for (bool is_open = any(is_on); is_open; is_open = false) {
            Seam seam = seam_at(push.frame.v.scene.v.gregory.v[patch_places.x], is_on, u, v);
            uint own = 6u * seam.edge;
            vec3 curve[4] = vec3[4](control_point[own], control_point[own + 1u], control_point[own + 2u],
                                    control_point[6u * ((seam.edge + 1u) & 3u)]);
            vec3 along[3] = vec3[3](difference(curve[1], curve[0]), difference(curve[2], curve[1]), difference(curve[3], curve[2]));
            share_point(seam, curve, along, u, v, position, normal);
        }
    }
    put_point(u, v, position, normal);
}
