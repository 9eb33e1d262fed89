// Appending to lists: threads of a group take places among themselves, and one of them takes a run in the list for all.
#ifndef PLANISH_APPEND
#define PLANISH_APPEND
#include "scene.glsl"

// Groups of CHUNK that cover a list; rows of 65535 where they are more.
void cover(ListHeads heads, uint list, uint count)
{
    uint groups = (min(count, heads.v[list].capacity) + CHUNK - 1u) / CHUNK;
    atomicMax(heads.v[list].groups_x, min(groups, 65535u));
    atomicMax(heads.v[list].groups_y, (groups + 65534u) / 65535u);
}

// The first of `count` places at the end of a list.
uint take_places(ListHeads heads, uint list, uint count)
{
    if (count == 0u) {
        return 0u;
    }
    uint first = atomicAdd(heads.v[list].count, count);
    cover(heads, list, first + count);
    return first;
}
#endif
