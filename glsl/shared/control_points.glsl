// The 16 control points of a bicubic patch, of which boundaries have some by reflection: 2 P - Q across a boundary edge,
// both ways at a corner. Once for a thread that makes one point, once for a thread that makes all; the bits are the same.
#ifndef PLANISH_CONTROL_POINTS
#define PLANISH_CONTROL_POINTS
#extension GL_EXT_control_flow_attributes : require
#include "tables.glsl"

vec3 stored_point(RegularPatches patches, Points points, uint patch_place, uint i)
{
    return points.v[patches.v[patch_place].points[i]];
}

// The place of the control point that a row or column index stands for, and of the one that reflects it.
uvec2 mirror(uint i, bool low, bool high)
{
    return i == 0 && low ? uvec2(1, 2) : (i == 3 && high ? uvec2(2, 1) : uvec2(i, i));
}

vec3 reflected_point(RegularPatches patches, Points points, uint patch_place, uint i, uint boundary)
{
    uvec2 column = mirror(i & 3u, (boundary & 8u) != 0u, (boundary & 2u) != 0u);
    uvec2 row = mirror(i >> 2, (boundary & 1u) != 0u, (boundary & 4u) != 0u);
    precise vec3 near = stored_point(patches, points, patch_place, 4 * row.x + column.x);
    precise vec3 far_row = near;
    if (column.x != column.y) {
        near = 2.0 * near - stored_point(patches, points, patch_place, 4 * row.x + column.y);
    }
    if (row.x == row.y) {
        return near;
    }
    far_row = stored_point(patches, points, patch_place, 4 * row.y + column.x);
    if (column.x != column.y) {
        far_row = 2.0 * far_row - stored_point(patches, points, patch_place, 4 * row.y + column.y);
    }
    precise vec3 result = 2.0 * near - far_row;
    return result;
}

// Control point i of a patch.
vec3 control_point_of(RegularPatches patches, Points points, uint patch_place, uint i, uint boundary)
{
    return boundary == 0u ? stored_point(patches, points, patch_place, i)
                          : reflected_point(patches, points, patch_place, i, boundary);
}

precise vec3 reflected(vec3 near, vec3 far)
{
    precise vec3 result = 2.0 * near - far;
    return result;
}

// Replaces those of 16 points that the boundary mask names: columns first, then whole rows, corners with them.
void reflect_points(inout vec3 p[16], uint boundary)
{
    [[unroll]] for (int row = 0; row < 16; row += 4) {
        p[row] = (boundary & 8u) != 0u ? reflected(p[row + 1], p[row + 2]) : p[row];
        p[row + 3] = (boundary & 2u) != 0u ? reflected(p[row + 2], p[row + 1]) : p[row + 3];
    }
    [[unroll]] for (int column = 0; column < 4; ++column) {
        p[column] = (boundary & 1u) != 0u ? reflected(p[4 + column], p[8 + column]) : p[column];
        p[12 + column] = (boundary & 4u) != 0u ? reflected(p[8 + column], p[4 + column]) : p[12 + column];
    }
}

// All control points of a patch, for a thread that needs them at once. No element of the array is chosen by a variable: hardware would
// have to keep the array in memory then, for every thread.
void patch_points(RegularPatches patches, Points points, uint patch_place, out vec3 p[16])
{
    [[unroll]] for (uint i = 0u; i < 16u; ++i) {
        p[i] = stored_point(patches, points, patch_place, i);
    }
    reflect_points(p, patch_boundary(patches.v[patch_place].info));
}
#endif
