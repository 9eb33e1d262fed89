#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING dump=DUMP
// ACC patches (Loop and Schaefer 2008): a bicubic patch for positions, and two patches of tangents, biquadratic by cubic, for normals.
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

precise vec3 step_between(vec3 from, vec3 to)
{
    precise vec3 result = 3.0 * (to - from);
    return result;
}

vec3 weigh_three(vec3 a, vec3 b, vec3 c, vec3 w)
{
    return a * w.x + b * w.y + c * w.z;
}

vec3 quadratic_basis(Parameter at)
{
    return vec3(at.s * at.s, 2.0 * (at.s * at.t), at.t * at.t);
}

vec3 edge_vector(uint edge, uint which) { return control_point[16u + 4u * edge + which]; }

Evaluated evaluate(Parameter u, Parameter v)
{
    // Row by row of v, the points of the corners.
    const uint PLACE[16] = uint[16](0u, 1u, 6u, 4u, 2u, 3u, 7u, 5u, 13u, 15u, 11u, 10u, 12u, 14u, 9u, 8u);
    vec3 b[16];
    [[unroll]] for (uint i = 0u; i < 16u; ++i) {
        b[i] = control_point[PLACE[i]];
    }
    vec4 nu;
    vec4 nv;
    vec4 slope;
    bernstein(u.t, u.s, nu, slope);
    bernstein(v.t, v.s, nv, slope);
    vec3 qu = quadratic_basis(u);
    vec3 qv = quadratic_basis(v);
    vec3 row[4];
    [[unroll]] for (uint j = 0u; j < 4u; ++j) {
        row[j] = weigh_ends(b[4u * j], b[4u * j + 1u], b[4u * j + 2u], b[4u * j + 3u], nu);
    }
    Evaluated result;
    result.position = weigh_ends(row[0], row[1], row[2], row[3], nv);
    vec3 along_u[4];
    along_u[0] = weigh_three(edge_vector(0u, 0u), step_between(b[1], b[2]), edge_vector(0u, 1u), qu);
    along_u[1] = weigh_three(edge_vector(3u, 3u), step_between(b[5], b[6]), -edge_vector(1u, 2u), qu);
    along_u[2] = weigh_three(edge_vector(3u, 2u), step_between(b[9], b[10]), -edge_vector(1u, 3u), qu);
    along_u[3] = weigh_three(-edge_vector(2u, 1u), step_between(b[13], b[14]), -edge_vector(2u, 0u), qu);
    result.along_u = weigh_ends(along_u[0], along_u[1], along_u[2], along_u[3], nv);
    vec3 along_v[4];
    along_v[0] = weigh_three(-edge_vector(3u, 1u), step_between(b[4], b[8]), -edge_vector(3u, 0u), qv);
    along_v[1] = weigh_three(edge_vector(0u, 2u), step_between(b[5], b[9]), -edge_vector(2u, 3u), qv);
    along_v[2] = weigh_three(edge_vector(0u, 3u), step_between(b[6], b[10]), -edge_vector(2u, 2u), qv);
    along_v[3] = weigh_three(edge_vector(1u, 0u), step_between(b[7], b[11]), edge_vector(1u, 1u), qv);
    result.along_v = weigh_ends(along_v[0], along_v[1], along_v[2], along_v[3], nu);
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
            uint next = (seam.edge + 1u) & 3u;
            vec3 curve[4] = vec3[4](control_point[4u * seam.edge], control_point[4u * seam.edge + 1u], control_point[4u * next + 2u],
                                    control_point[4u * next]);
            vec3 along[3] = vec3[3](edge_vector(seam.edge, 0u), step_between(curve[1], curve[2]), edge_vector(seam.edge, 1u));
            share_point(seam, curve, along, u, v, position, normal);
        }
    }
    put_point(u, v, position, normal);
}
