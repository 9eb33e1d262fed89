// Displacement of Gregory patches. Along edges one face decides for both sides: the direction is the normal that they share, the place
// in the map that of the edge's owner. Included where `push` and `patch_places` are declared.
#ifndef PLANISH_GREGORY_DISPLACEMENT
#define PLANISH_GREGORY_DISPLACEMENT
#include "gregory.glsl"
#include "gregory_seams.glsl"
#include "patch_maps.glsl"

MapPlace place_in_face(SceneTables scene, Object object, uint ptex_face, Parameter u, Parameter v)
{
    MapPlace result;
    result.ptex_face = ptex_face;
    result.u = u;
    result.v = v;
    result.uv = without_sign_of_zero(vec3(tree_tex_coord(scene, object, ptex_face, vec2(u.t, v.t)), 0.0)).xy;
    return result;
}

float lod_in_face(SceneTables scene, Object object, MapPlace place)
{
    vec4 corners = corner_densities(face_lods(scene, object, place.ptex_face), PatchInfo(place.ptex_face, 0u, 0u));
    return between_corners(corners, place.u, place.v);
}

Parameter doubled(Parameter along)
{
    precise float t = 2.0 * along.t;
    precise float s = along.s - along.t;
    return Parameter(t, s);
}

// A point of an edge in the face that owns the edge.
MapPlace owner_place(SceneTables scene, Object object, EdgeOwner owner, Parameter at)
{
    const Parameter LOW = Parameter(0.0, 1.0);
    const Parameter HIGH = Parameter(1.0, 0.0);
    if ((owner.flags & 4u) != 0u) {
        at = turned(at);
    }
    bool is_first = at.t <= at.s;
    uint edge = owner.flags & 3u;
    Parameter u = edge == 0u ? at : (edge == 1u ? HIGH : (edge == 2u ? turned(at) : LOW));
    Parameter v = edge == 0u ? LOW : (edge == 1u ? at : (edge == 2u ? HIGH : turned(at)));
    if ((owner.flags & 8u) != 0u) {
        u = is_first ? doubled(at) : LOW;
        v = is_first ? LOW : doubled(turned(at));
    }
    return place_in_face(scene, object, owner.faces[is_first ? 0 : 1], u, v);
}

// The place in the map that decides for all faces at a point on edges; `own` is that of this face.
MapPlace deciding_place(SceneTables scene, Object object, GregoryFace face, Seam seam, bvec4 is_on, MapPlace own)
{
    const Parameter HIGH = Parameter(1.0, 0.0);
    if (seam.is_outer) {
        return owner_place(scene, object, face.owners[seam.of_face], seam.at);
    }
    // Inside a face of other than four sides: the part whose edge to the centre it is; the centre is the first part's.
    if (is_on.y && is_on.z && gregory_kind(face) == GREGORY_TRIANGLE) {
        return place_in_face(scene, object, own.ptex_face - gregory_part(face), HIGH, HIGH);
    }
    return is_on.z ? place_in_face(scene, object, face.part_before, HIGH, own.u) : own;
}

// The direction along an edge with a sharp edge's normals on both sides: between those that its ends have.
vec3 direction_on_crease(SceneTables scene, Object object, GregoryFace face, Seam seam)
{
    uint count = gregory_kind(face) == GREGORY_TRIANGLE ? 3u : 4u;
    uint next = seam.of_face + 1u == count ? 0u : seam.of_face + 1u;
    LimitPoint from = scene.v.limits.v[scene.v.limit_seats.v[face.limits[seam.of_face]].canonical];
    LimitPoint to = scene.v.limits.v[scene.v.limit_seats.v[face.limits[next]].canonical];
    precise vec3 sum = seam.at.s * normal_to_world(object, from.normal) + seam.at.t * normal_to_world(object, to.normal);
    return without_sign_of_zero(unit_vector(sum));
}

// Moves a point of a patch, whose tangents these are, by its object's map. The normal becomes the direction that it is moved in;
// returns that of the displaced surface. `border_normal` is that of the bicubic patch across, if one decides.
vec3 displace(bvec4 is_on, Seam seam, Parameter u, Parameter v, uint ptex_face, vec3 along_u, vec3 along_v, vec3 border_normal,
              inout vec3 position, inout vec3 normal)
{
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[patch_places.y];
    vec3 shading_normal = normal;
    for (bool is_open = object.map != NONE; is_open; is_open = false) {
        DisplacementMap map = scene.v.maps.v[object.map];
        GregoryFace face = scene.v.gregory.v[patch_places.x];
        MapPlace own = place_in_face(scene, object, ptex_face, u, v);
        MapPlace place = own;
        vec3 direction = normal;
        for (bool is_edge = any(is_on); is_edge; is_edge = false) {
            place = deciding_place(scene, object, face, seam, is_on, own);
            bool is_alone = seam.is_outer && (face.owners[seam.of_face].flags & 16u) != 0u;
            if (seam.is_sharp && !is_alone) {
                direction = direction_on_crease(scene, object, face, seam);
            }
        }
        float lod = lod_in_face(scene, object, place);
        for (bool is_border = seam.border != NONE && seam.limit == NONE; is_border; is_border = false) {
            BorderPoint border = border_point(seam.border, (seam.edge & 1u) == 0u ? u : v);
            place = map_place(object, border.place, border.u, border.v, lod);
            vec4 nu;
            vec4 du;
            vec4 nv;
            vec4 dv;
            cubic_basis(border.u.t, border.u.s, nu, du);
            cubic_basis(border.v.t, border.v.s, nv, dv);
            place.uv = map.layout_kind == LAYOUT_FACES ? vec2(0.0) : tex_point(object, border.place, border.u, border.v, nu, du, nv, dv).at;
            direction = border_normal;
        }
        for (bool is_limit = seam.limit != NONE; is_limit; is_limit = false) {
            LimitSeat seat = scene.v.limit_seats.v[seam.limit];
            direction = normal_to_world(object, scene.v.limits.v[seat.canonical].normal);
            place = own;
            place.uv = seat.uv;
            lod = lod_in_face(scene, object, own);
        }
        TexPoint tex = TexPoint(vec2(0.0), vec2(1.0, 0.0), vec2(0.0, 1.0));
        for (bool is_uv = map.layout_kind != LAYOUT_FACES; is_uv; is_uv = false) {
            tex = tree_tex_point(scene, object, ptex_face, vec2(u.t, v.t));
        }
        MapSamples samples = sample_around(map, place, own, lod);
        position = displaced(position, displacement_vector(object, map, samples.value, direction));
        vec3 da = displacement_vector(object, map, samples.along_s * tex.along_u.x + samples.along_t * tex.along_u.y, direction);
        vec3 db = displacement_vector(object, map, samples.along_s * tex.along_v.x + samples.along_t * tex.along_v.y, direction);
        shading_normal = displaced_normal(along_u, along_v, da, db, normal);
        normal = direction;
    }
    return shading_normal;
}
#endif
