// Points of the surface as rows of a table (Hollaender and Boubekeur 2010, equation 1): relative to the first control, which keeps the
// digits of nearby points. Included where `push` is the draw's.
#ifndef PLANISH_TABLE_ROWS
#define PLANISH_TABLE_ROWS
#include "frame.glsl"

// Where normals come from.
const uint NORMALS_TANGENTS = 0;   // tangents of the limit surface, by a table of their own
const uint NORMALS_SUBDIVISION = 1; // Subdivision Shading (Alexa and Boubekeur 2008): normals weighed as positions are
const uint NORMALS_GEOMETRIC = 2;  // interpolated between those of the mesh that was split
layout(constant_id = 15) const uint NORMALS = NORMALS_TANGENTS;

// Whether weights have 16 bits.
layout(constant_id = 16) const bool SHORT_WEIGHTS = false;

float table_weight(SceneTables scene, uint at)
{
    if (SHORT_WEIGHTS) {
        vec2 both = unpackSnorm2x16(scene.v.short_weights.v[at >> 1]);
        return scene.v.short_scale * ((at & 1u) != 0u ? both.y : both.x);
    }
    return scene.v.table_weights.v[at];
}

vec2 table_slope(SceneTables scene, uint at)
{
    return SHORT_WEIGHTS ? unpackSnorm2x16(scene.v.short_tangents.v[at]) : scene.v.table_tangents.v[at];
}

// A point in the mesh's own space, and its unit normal.
struct TablePoint {
    vec3 position;
    vec3 normal;
};

// Where a table and what it weighs begin.
struct TableRange {
    uint first_control;
    uint control_count;
    uint first_weight;
};

TablePoint table_row(SceneTables scene, TableRange range, uint row)
{
    precise vec3 origin = scene.v.points.v[scene.v.table_controls.v[range.first_control]];
    precise vec3 position = vec3(0.0);
    precise vec3 along_u = vec3(0.0);
    precise vec3 along_v = vec3(0.0);
    uint first = range.first_weight + row * range.control_count;
    for (uint i = NORMALS == NORMALS_SUBDIVISION ? 0u : 1u; i < range.control_count; ++i) {
        uint control = scene.v.table_controls.v[range.first_control + i];
        precise vec3 offset = scene.v.points.v[control] - origin;
        float weight = table_weight(scene, first + i);
        position = position + weight * offset;
        if (NORMALS == NORMALS_TANGENTS) {
            vec2 slope = table_slope(scene, first + i);
            along_u = along_u + slope.x * offset;
            along_v = along_v + slope.y * offset;
        } else if (NORMALS == NORMALS_SUBDIVISION) {
            along_u = along_u + weight * scene.v.table_normals.v[control];
        }
    }
    position = origin + position;
    return TablePoint(position, NORMALS == NORMALS_TANGENTS ? unit_normal(along_u, along_v) : unit_vector(along_u));
}

// The same at the next moment, the position alone.
vec3 next_table_row(SceneTables scene, TableRange range, uint row)
{
    vec3 origin = scene.v.next_points.v[scene.v.table_controls.v[range.first_control]];
    vec3 position = origin;
    uint first = range.first_weight + row * range.control_count;
    for (uint i = 1u; i < range.control_count; ++i) {
        vec3 offset = scene.v.next_points.v[scene.v.table_controls.v[range.first_control + i]] - origin;
        position += table_weight(scene, first + i) * offset;
    }
    return position;
}

// Half way between two points.
TablePoint table_middle(TablePoint a, TablePoint b)
{
    precise vec3 position = 0.5 * (a.position + b.position);
    precise vec3 normal = 0.5 * (a.normal + b.normal);
    return TablePoint(position, normal);
}

// From one point to another.
TablePoint table_between(TablePoint from, TablePoint to, float t)
{
    precise vec3 position = from.position + t * (to.position - from.position);
    precise vec3 normal = from.normal + t * (to.normal - from.normal);
    return TablePoint(position, unit_vector(normal));
}
#endif
