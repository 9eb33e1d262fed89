// Evaluating a neighbour's bicubic patch on a common edge. Included where `patch_places` and `push` are declared.
#ifndef PLANISH_BORDER
#define PLANISH_BORDER
#include "seams.glsl"

precise vec3 over_36(vec3 a)
{
    precise vec3 result = a / 36.0;
    return result;
}

precise vec3 patch_position(vec3 p[16], vec4 nu, vec4 nv)
{
    precise vec3 result = weigh_patch(p, nu, nv) / 36.0;
    return result;
}

precise vec3 curve_position(vec3 p[4], vec4 n)
{
    precise vec3 result = weigh(p[0], p[1], p[2], p[3], n) / 6.0;
    return result;
}

// The control points around an edge of another patch; the others have no weight there, and are any points. No element of the array is
// chosen by a variable: hardware would have to keep all of it in memory, for every point of every patch.
void border_points(BorderPoint border, inout vec3 p[16])
{
    Object object = push.frame.v.scene.v.objects.v[patch_places.y];
    uint boundary = patch_boundary(push.patches.v[border.place].info);
    vec3 q[16];
    [[unroll]] for (uint i = 0u; i < 16u; ++i) {
        q[i] = vec3(0.0);
        if (is_beside(border.edge, i)) {
            q[i] = stored_point(push.patches, push.points, border.place, i);
        }
    }
    reflect_points(q, boundary);
    [[unroll]] for (uint i = 0u; i < 16u; ++i) {
        p[i] = to_world(object, q[i]);
    }
}

// The control points of the curve that another patch has along a sharp edge.
void border_curve(BorderPoint border, out vec3 q[4])
{
    Object object = push.frame.v.scene.v.objects.v[patch_places.y];
    uint boundary = patch_boundary(push.patches.v[border.place].info);
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        q[i] = stored_point(push.patches, push.points, border.place, along_edge(border.edge, i));
    }
    bool is_along_u = (border.edge & 1u) == 0u;
    q[0] = (boundary & (is_along_u ? 8u : 1u)) != 0u ? reflected(q[1], q[2]) : q[0];
    q[3] = (boundary & (is_along_u ? 2u : 4u)) != 0u ? reflected(q[2], q[1]) : q[3];
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        q[i] = to_world(object, q[i]);
    }
}

// The weights of that curve's points.
vec4 border_weights(BorderPoint border)
{
    Parameter along = (border.edge & 1u) == 0u ? border.u : border.v;
    vec4 n;
    vec4 slope;
    cubic_basis(along.t, along.s, n, slope);
    return n;
}
#endif
