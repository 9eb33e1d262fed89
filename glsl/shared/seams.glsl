// What a regular patch takes from other patches so that both have the same bits: limit points at corners, and along halves of
// a coarser patch's edge that patch's control points. Where surfaces are displaced, one patch decides for both sides of creases and of
// seams of texture coordinates.
#ifndef PLANISH_SEAMS
#define PLANISH_SEAMS
#include "control_points.glsl"
#include "scene.glsl"
#include "spacing.glsl"

const uint NO_EDGE = 4;

// Where a point on an edge lies in the patch along it that decides there.
struct BorderPoint {
    uint place; // of that patch
    uint edge;
    Parameter u;
    Parameter v;
};

BorderPoint border_point(uint border, Parameter along)
{
    BorderPoint result;
    result.place = border >> 5;
    result.edge = border >> 3 & 3u;
    uint part = border >> 1 & 3u;
    if ((border & 1u) != 0u) {
        along = Parameter(along.s, along.t);
    }
    // As edge_point has it for an edge of two halves.
    precise float near = 0.5 * along.t;
    precise float far = 0.5 + 0.5 * along.s;
    precise float beyond = 0.5 + 0.5 * along.t;
    precise float rest = 0.5 * along.s;
    Parameter whole = part == 0u ? Parameter(near, far) : (part == 1u ? Parameter(beyond, rest) : along);
    Parameter across = result.edge == 1u || result.edge == 2u ? Parameter(1.0, 0.0) : Parameter(0.0, 1.0);
    bool is_along_u = (result.edge & 1u) == 0u;
    result.u = is_along_u ? whole : across;
    result.v = is_along_u ? across : whole;
    return result;
}

// Whether control point i has a weight on an edge: the row opposite has none, and need not have been computed.
bool is_beside(uint edge, uint i)
{
    uint column = i & 3u;
    uint row = i >> 2;
    return edge == 0u ? row < 3u : (edge == 2u ? row > 0u : (edge == 3u ? column < 3u : column > 0u));
}

// The places of the four control points along an edge.
uint along_edge(uint edge, uint i)
{
    return edge == 0u ? 4u + i : (edge == 2u ? 8u + i : (edge == 3u ? 1u + 4u * i : 2u + 4u * i));
}
#endif
