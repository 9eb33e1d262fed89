// Marks of the points and limit points that a frame needs.
#ifndef PLANISH_MARKS
#define PLANISH_MARKS
#include "scene.glsl"

// Whether the bit was not set before.
bool set_bit(Bits bits, uint place)
{
    uint bit = 1u << (place & 31u);
    // Looking first spares most of the atomics: neighbours share what they need.
    return (bits.v[place >> 5] & bit) == 0u && (atomicOr(bits.v[place >> 5], bit) & bit) == 0u;
}

void mark_limit(SceneTables scene, uint limit)
{
    if (limit != NONE) {
        set_bit(scene.v.marks, scene.v.first_limit_mark + limit);
    }
}

// The limit point at a corner, and the one that says where it is displaced to.
void mark_corner(SceneTables scene, uint limit)
{
    mark_limit(scene, limit);
    if (DISPLACED && limit != NONE) {
        mark_limit(scene, scene.v.limit_seats.v[limit].canonical);
    }
}

// The points one level down around a vertex.
void mark_star(SceneTables scene, uint star)
{
    if (star == NONE || !set_bit(scene.v.star_marks, star)) {
        return;
    }
    for (uint i = scene.v.star_first.v[star]; i < scene.v.star_first.v[star + 1u]; ++i) {
        set_bit(scene.v.marks, scene.v.star_marks_of.v[i]);
    }
}
#endif
