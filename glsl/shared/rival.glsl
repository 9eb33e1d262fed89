// What the control shaders of ACC and Pm-patches make their points of. In f64: crates/subdiv/src/gregory/acc.rs, pm.rs.
#ifndef PLANISH_RIVAL
#define PLANISH_RIVAL
#include "scene.glsl"

vec3 corner_position(SceneTables scene, GregoryFace face, uint corner)
{
    return scene.v.limits.v[face.limits[corner & 3u]].position;
}

SpokePoint spoke_out(SceneTables scene, GregoryFace face, uint edge) { return scene.v.spokes.v[face.first[edge]]; }
SpokePoint spoke_into(SceneTables scene, GregoryFace face, uint edge) { return scene.v.spokes.v[face.last[edge]]; }
vec3 middle_out(SceneTables scene, GregoryFace face, uint edge) { return scene.v.spoke_middles.v[face.first[edge]]; }
vec3 middle_into(SceneTables scene, GregoryFace face, uint edge) { return scene.v.spoke_middles.v[face.last[edge]]; }

// The point of the face next to a corner along both axes.
precise vec3 inner_point(SceneTables scene, GregoryFace face, uint corner)
{
    precise vec3 result = middle_out(scene, face, corner) + spoke_out(scene, face, corner).beside / 3.0;
    return result;
}

precise vec3 scaled_by(float scale, vec3 a)
{
    precise vec3 result = scale * a;
    return result;
}

// Vector i of the field across an edge, to the left, in Bezier form. The same bits turned over, seen from the other side.
vec3 across_edge(SceneTables scene, GregoryFace face, uint edge, uint i, float scale)
{
    if (i == 0u) {
        return spoke_out(scene, face, edge).across;
    }
    if (i == 1u) {
        return scaled_by(scale, spoke_out(scene, face, edge).beside);
    }
    if (i == 2u) {
        return -scaled_by(scale, spoke_into(scene, face, edge).beside);
    }
    return -spoke_into(scene, face, edge).across;
}
#endif
