#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING dump=DUMP lean_maps=LEAN,MAPS layers_maps=LAYERS,MAPS colors_maps=LAYERS,COLORS,MAPS shading_maps=SHADING,MAPS dump_maps=DUMP,MAPS
// Regular and transition patches: evaluates the bicubic B-spline (FAS section 5.1).
#extension GL_GOOGLE_include_directive : require
#include "shared/spacing.glsl"
#include "shared/bspline.glsl"
#include "shared/crease.glsl"
#include "shared/seams.glsl"
#include "shared/tex_tree.glsl"
#include "shared/colors.glsl"
#include "shared/motion.glsl"
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
#include "shared/domain.glsl"
#include "shared/border.glsl"

uint own_place()
{
    return patch_words.w & ~PATCH_MIRRORED;
}

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
    vec3 along_u; // tangents, times 12
    vec3 along_v;
    vec4 nu;      // the weights that they were evaluated with,
    vec4 du;
    vec4 nv;
    vec4 dv;
    uint place;   // in this patch,
    Parameter u;  // at this point of it
    Parameter v;
    uint limit;   // the limit point that it is, or NONE
    BorderPoint decider; // where surfaces are displaced: the patch that says where to, if it is another one
};

// What decides about a point on an edge: a patch along it, or the limit point that a corner is.
void find_deciders(bvec4 is_on, Parameter u, Parameter v, out BorderPoint border, out uint border_edge, out uint limit)
{
    SeamTable seams = push.frame.v.scene.v.seams;
    uint word = NONE;
    limit = NONE;
    border.place = NONE;
    border_edge = NO_EDGE;
    uint borders[4] = seams.v[patch_places.x].borders;
    [[unroll]] for (uint edge = 0u; edge < 4u; ++edge) {
        uint found = is_on[edge] ? borders[edge] : NONE;
        if (found != NONE) {
            word = found;
            border_edge = edge;
        }
        // Corner i lies between edge i - 1 and edge i.
        if (is_on[edge] && is_on[(edge + 3u) & 3u]) {
            limit = seams.v[patch_places.x].limits[edge];
        }
    }
    if (word != NONE && limit == NONE) {
        border = border_point(word, (border_edge & 1u) == 0u ? u : v);
    }
}

// The point on edges without a surface across: boundaries and infinite creases. There the surface is the curve of the points along
// the edge, whatever lies beside it.
vec3 sharp_position(uint sharp_edges, BorderPoint border, vec4 nu, vec4 nv)
{
    uint edge = uint(findLSB(sharp_edges));
    uint rest = sharp_edges & (sharp_edges - 1u);
    if (rest != 0u) {
        // Two of them meet in a corner that is interpolated: corner 0 lies between edges 3 and 0; else the higher edge begins there.
        uint other = uint(findLSB(rest));
        uint corner = edge == 0u && other == 3u ? 0u : other;
        const uint PLACES[4] = uint[4](5u, 6u, 10u, 9u);
        // Threads that are not here have no corner, but a software driver reads their elements of arrays too.
        return control_point[PLACES[corner & 3u]];
    }
    vec3 q[4];
    vec4 n = (edge & 1u) == 0u ? nu : nv;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        q[i] = control_point[along_edge(edge, i)];
    }
    if (border.place != NONE) {
        border_curve(border, q);
        n = border_weights(border);
    }
    return curve_position(q, n);
}

// Evaluates so that every patch at an edge or a corner gets the same bits. What few points need is in loops, not in branches: a
// software driver runs the body of a branch that no thread takes, but not that of a loop.
Evaluated evaluate_watertight(Parameter u, Parameter v, bvec4 is_on, PatchInfo info)
{
    Evaluated result;
    vec3 p[16];
    [[unroll]] for (int i = 0; i < 16; ++i) {
        p[i] = control_point[i];
    }
    uint crease = patch_crease(info);
    float sharpness = patch_sharpness;
    uint sharp_edges = 0u;
    [[unroll]] for (uint edge = 0u; edge < 4u; ++edge) {
        sharp_edges |= is_on[edge] ? patch_boundary(info) & 1u << edge : 0u;
    }
    BorderPoint border;
    border.place = NONE;
    uint border_edge = NO_EDGE;
    result.limit = NONE;
    result.place = own_place();
    for (bool is_open = patch_places.x != NONE && any(is_on); is_open; is_open = false) {
        find_deciders(is_on, u, v, border, border_edge, result.limit);
    }
    bool is_sharp_border = border.place != NONE && (sharp_edges >> border_edge & 1u) != 0u;
    for (bool is_open = border.place != NONE && !is_sharp_border; is_open; is_open = false) {
        border_points(border, p);
        if (CREASE) {
            crease = patch_crease(push.patches.v[border.place].info);
            sharpness = push.patches.v[border.place].sharpness;
        }
        result.place = border.place;
        u = border.u;
        v = border.v;
    }
    result.decider = border;
    result.u = u;
    result.v = v;
    basis(u, v, crease, sharpness, result.nu, result.du, result.nv, result.dv);
    vec3 position;
    weigh_patch_and_tangents(p, result.nu, result.du, result.nv, result.dv, position, result.along_u, result.along_v);
    result.position = over_36(position);
    result.normal = without_sign_of_zero(unit_normal(result.along_u, result.along_v));
    for (bool is_open = sharp_edges != 0u; is_open; is_open = false) {
        result.position = sharp_position(sharp_edges, border, result.nu, result.nv);
    }
    result.position = without_sign_of_zero(result.position);
    for (bool is_open = result.limit != NONE; is_open; is_open = false) {
        Object object = push.frame.v.scene.v.objects.v[patch_places.y];
        LimitPoint point = push.frame.v.scene.v.limits.v[result.limit];
        result.position = to_world(object, point.position);
        result.normal = normal_to_world(object, point.normal);
    }
    return result;
}

// Evaluates with fewer operations, each patch by itself.
Evaluated evaluate(Parameter u, Parameter v, PatchInfo info)
{
    Evaluated result;
    result.limit = NONE;
    result.place = own_place();
    result.decider.place = NONE;
    result.u = u;
    result.v = v;
    basis(u, v, patch_crease(info), patch_sharpness, result.nu, result.du, result.nv, result.dv);
    precise vec3 column[4];
    precise vec3 slope[4];
    for (int i = 0; i < 4; ++i) {
        column[i] = weigh(control_point[i], control_point[4 + i], control_point[8 + i], control_point[12 + i], result.nv);
        slope[i] = weigh(control_point[i], control_point[4 + i], control_point[8 + i], control_point[12 + i], result.dv);
    }
    precise vec3 position = weigh(column[0], column[1], column[2], column[3], result.nu) / 36.0;
    result.position = position;
    result.along_u = weigh(column[0], column[1], column[2], column[3], result.du);
    result.along_v = weigh(slope[0], slope[1], slope[2], slope[3], result.nu);
    result.normal = unit_normal(result.along_u, result.along_v);
    return result;
}

#if defined(MAPS)
#include "shared/bspline_displacement.glsl"
#endif

#if defined(COLORS) || defined(SHADING) || defined(DUMP)
// The colour of a point, by the weights of its position; `uv` is its place in its Ptex face.
vec3 point_color(Evaluated point, uint ptex_face, vec2 uv)
{
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[patch_places.y];
    vec3 result = vec3(1.0);
    for (bool is_open = (object.flags & OBJECT_VERTEX_COLORS) != 0u; is_open; is_open = false) {
        vec3 p[16];
        patch_points(push.patches, scene.v.point_colors, point.place, p);
        result = patch_position(p, point.nu, point.nv);
    }
    for (bool is_open = (object.flags & OBJECT_VARYING_COLORS) != 0u; is_open; is_open = false) {
        result = varying_color(scene, object, ptex_face - object.first_face, uv);
    }
    return result;
}
#endif

#if defined(COLORS)
// Where a point is at the next moment: by the weights of its position now.
vec3 next_position(Evaluated point)
{
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[patch_places.y];
    vec3 result = point.position;
    for (bool is_open = (object.flags & OBJECT_DEFORMS) != 0u && point.limit == NONE; is_open; is_open = false) {
        vec3 p[16];
        patch_points(push.patches, scene.v.next_points, point.place, p);
        result = patch_position(p, point.nu, point.nv);
    }
    return point.limit == NONE ? moved_on(object, result) : next_limit(scene, object, point.limit, result);
}
#endif

void main()
{
    Parameter u;
    Parameter v;
    bvec4 is_on;
    domain_point(u, v, is_on);
    PatchInfo info = PatchInfo(patch_words.x, patch_words.y, patch_words.z);
    Evaluated point;
    if (WATERTIGHT) {
        point = evaluate_watertight(u, v, is_on, info);
    } else {
        point = evaluate(u, v, info);
    }
    vec2 st = vec2(0.0);
    vec3 shading_normal = point.normal;
#if defined(MAPS)
    TexPoints tex = tex_points(point, u, v, is_decided_across(point));
    st = tex.own;
    shading_normal = displace(point, tex);
#elif defined(SHADING) || defined(DUMP) || defined(COLORS)
    if (TEX_COORDS) {
        SceneTables scene = push.frame.v.scene;
        Object object = scene.v.objects.v[patch_places.y];
        st = tree_tex_coord(scene, object, info.ptex_face - object.first_face, ptex_uv(info, vec2(u.t, v.t)));
    }
#endif
    put_surface_point(point.position, point.normal, shading_normal, vec2(u.t, v.t), st, info, patch_words.w,
                      patch_transition(info) != 0u ? KIND_TRANSITION : KIND_REGULAR, shown_factor());
    put_object(patch_places.y);
#if defined(COLORS) || defined(SHADING) || defined(DUMP)
    if (COLORED) {
        put_color(point_color(point, info.ptex_face, ptex_uv(info, vec2(u.t, v.t))));
    }
#endif
#if defined(COLORS)
    if (MOVING) {
        put_next_position(next_position(point));
    }
#endif
}
