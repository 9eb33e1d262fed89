// Displacement of regular and transition patches. Included by their evaluation shader, in the variants for surfaces that are displaced:
// drivers take longer to see that code is never reached than to compile what is.
#ifndef PLANISH_BSPLINE_DISPLACEMENT
#define PLANISH_BSPLINE_DISPLACEMENT
#include "displacement.glsl"
#include "patch_maps.glsl"

// Whether the direction and the texture coordinates of a displaced point are another patch's, across a crease.
bool is_decided_across(Evaluated point)
{
    return point.limit == NONE && point.decider.place != NONE && point.decider.place != point.place;
}

// Texture coordinates and what else is known of a point: in the patch that it was evaluated in, in the one that decides where it is
// displaced to, and in its own. A loop, so that drivers compile its long body once.
struct TexPoints {
    TexPoint evaluated;
    vec2 deciding;
    vec2 own;
};

TexPoints tex_points(Evaluated point, Parameter u, Parameter v, bool wants_deciding)
{
    Object object = push.frame.v.scene.v.objects.v[patch_places.y];
    SceneTables scene = push.frame.v.scene;
    TexPoints result = TexPoints(TexPoint(vec2(0.0), vec2(0.0), vec2(0.0)), vec2(0.0), vec2(0.0));
    // Maps over Ptex faces need none, and meshes that have such may have none to read.
    bool is_looked_up = false;
    for (bool is_open = object.map != NONE; is_open; is_open = false) {
        is_looked_up = scene.v.maps.v[object.map].layout_kind != LAYOUT_FACES;
    }
    [[dont_unroll]] for (uint i = 0u; i < 3u; ++i) {
        bool is_wanted = i == 0u ? is_looked_up : (i == 1u ? is_looked_up && wants_deciding : TEX_COORDS);
        uint place = i == 0u ? point.place : (i == 1u ? point.decider.place : own_place());
        Parameter at_u = point.u;
        Parameter at_v = point.v;
        if (i == 1u) {
            at_u = point.decider.u;
            at_v = point.decider.v;
        }
        if (i == 2u) {
            at_u = u;
            at_v = v;
        }
        for (bool is_open = is_wanted; is_open; is_open = false) {
            vec4 nu;
            vec4 du;
            vec4 nv;
            vec4 dv;
            basis(at_u, at_v, patch_crease(push.patches.v[place].info), push.patches.v[place].sharpness, nu, du, nv, dv);
            TexPoint found = tex_point(object, place, at_u, at_v, nu, du, nv, dv);
            if (i == 0u) {
                result.evaluated = found;
            } else if (i == 1u) {
                result.deciding = found.at;
            } else {
                result.own = found.at;
            }
        }
    }
    return result;
}

// The direction in which the patch across a crease displaces.
vec3 deciding_normal(BorderPoint decider)
{
    vec3 p[16];
    border_points(decider, p);
    vec4 nu;
    vec4 du;
    vec4 nv;
    vec4 dv;
    PatchInfo info = push.patches.v[decider.place].info;
    basis(decider.u, decider.v, patch_crease(info), push.patches.v[decider.place].sharpness, nu, du, nv, dv);
    return without_sign_of_zero(unit_normal(weigh_patch(p, du, nv), weigh_patch(p, nu, dv)));
}

// Moves a point by its object's displacement map. The normal becomes the direction that it is moved in; returns the normal of the
// displaced surface.
vec3 displace(inout Evaluated point, TexPoints tex)
{
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[patch_places.y];
    vec3 shading_normal = point.normal;
    for (bool is_open = object.map != NONE; is_open; is_open = false) {
        DisplacementMap map = scene.v.maps.v[object.map];
        float lod;
        MapPlace own = map_place(object, point.place, point.u, point.v, lod);
        own.uv = tex.evaluated.at;
        MapPlace place = own;
        vec3 direction = point.normal;
        // Across a crease, and at corners, the direction and the texture coordinates are not this patch's own.
        for (bool is_other = is_decided_across(point); is_other; is_other = false) {
            direction = deciding_normal(point.decider);
            place = map_place(object, point.decider.place, point.decider.u, point.decider.v, lod);
            place.uv = tex.deciding;
        }
        for (bool is_limit = point.limit != NONE; is_limit; is_limit = false) {
            LimitSeat seat = scene.v.limit_seats.v[point.limit];
            direction = normal_to_world(object, scene.v.limits.v[seat.canonical].normal);
            place.uv = seat.uv;
        }
        bool is_of_faces = map.layout_kind == LAYOUT_FACES;
        float scale = 12.0 * halvings(patch_depth(push.patches.v[point.place].info));
        vec2 along_u = is_of_faces ? vec2(scale, 0.0) : tex.evaluated.along_u;
        vec2 along_v = is_of_faces ? vec2(0.0, scale) : tex.evaluated.along_v;
        MapSamples samples = sample_around(map, place, own, lod);
        point.position = displaced(point.position, displacement_vector(object, map, samples.value, direction));
        vec3 da = displacement_vector(object, map, samples.along_s * along_u.x + samples.along_t * along_u.y, direction);
        vec3 db = displacement_vector(object, map, samples.along_s * along_v.x + samples.along_t * along_v.y, direction);
        shading_normal = displaced_normal(point.along_u, point.along_v, da, db, point.normal);
        point.normal = direction;
    }
    return shading_normal;
}
#endif
