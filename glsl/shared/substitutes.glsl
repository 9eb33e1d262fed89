// Substitutes of subdivision surfaces over the faces of a cage, by their corners' positions and normals alone; all are the same along an
// edge whichever face asks: what the other corners add there is 0, and sums of two do not depend on their order.
#ifndef PLANISH_SUBSTITUTES
#define PLANISH_SUBSTITUTES
#include "table_rows.glsl"

const uint EVALUATE_TABLE = 0;
const uint EVALUATE_FLAT = 1;
const uint EVALUATE_PHONG = 2; // Phong tessellation, Boubekeur and Alexa 2008
const uint EVALUATE_PN = 3;    // Curved PN triangles, Vlachos et al. 2001
layout(constant_id = 14) const uint EVALUATE = EVALUATE_TABLE;

// How far Phong tessellation goes towards the tangent planes: the paper's 3/4.
const float PHONG_SHARE = 0.75;

struct Corners {
    vec3 position[4];
    vec3 normal[4];
};

// Weights of the corners: bilinear, or the three of a triangle.
precise vec4 corner_weights(vec2 uv, bool is_triangle)
{
    precise vec2 rest = 1.0 - uv;
    precise vec4 quad = vec4(rest.x * rest.y, uv.x * rest.y, uv.x * uv.y, rest.x * uv.y);
    precise vec4 triangle = vec4(rest.x - uv.y, uv.x, uv.y, 0.0);
    return is_triangle ? triangle : quad;
}

precise vec3 mixed(vec3 a[4], vec4 weights)
{
    precise vec3 result = (weights.x * a[0] + weights.y * a[1]) + (weights.z * a[2] + weights.w * a[3]);
    return result;
}

// How far point p moves to the plane through a corner across its normal.
precise vec3 to_plane(vec3 p, vec3 corner, vec3 normal, float weight)
{
    precise vec3 offset = corner - p;
    precise vec3 result = (weight * precise_dot(offset, normal)) * normal;
    return result;
}

precise vec3 phong_point(Corners corners, vec4 weights)
{
    precise vec3 p = mixed(corners.position, weights);
    precise vec3 first = to_plane(p, corners.position[0], corners.normal[0], weights.x) + to_plane(p, corners.position[1], corners.normal[1], weights.y);
    precise vec3 rest = to_plane(p, corners.position[2], corners.normal[2], weights.z) + to_plane(p, corners.position[3], corners.normal[3], weights.w);
    precise vec3 result = p + PHONG_SHARE * (first + rest);
    return result;
}

// The Bezier point a third of the way from one corner to another, in the tangent plane of the first.
precise vec3 pn_edge_point(Corners corners, uint from, uint to)
{
    precise vec3 along = corners.position[to] - corners.position[from];
    precise vec3 result = (2.0 * corners.position[from] + corners.position[to] - precise_dot(along, corners.normal[from]) * corners.normal[from]) / 3.0;
    return result;
}

// Their sum of an edge, with the cubic weights, less those of its ends.
precise vec3 pn_edge(vec3 near_a, vec3 near_b, float a, float b)
{
    precise vec3 result = (3.0 * a * a * b) * near_a + (3.0 * b * b * a) * near_b;
    return result;
}

precise vec3 pn_point(Corners corners, vec4 weights)
{
    vec3 near[6];
    [[unroll]] for (uint i = 0u; i < 3u; ++i) {
        near[2u * i] = pn_edge_point(corners, i, (i + 1u) % 3u);
        near[2u * i + 1u] = pn_edge_point(corners, (i + 1u) % 3u, i);
    }
    precise vec3 of_edges = ((near[0] + near[1]) + (near[2] + near[3])) + (near[4] + near[5]);
    precise vec3 of_corners = (corners.position[0] + corners.position[1]) + corners.position[2];
    precise vec3 middle = of_edges / 4.0 - of_corners / 6.0;
    precise vec3 cubes = vec3(weights.x * weights.x * weights.x, weights.y * weights.y * weights.y, weights.z * weights.z * weights.z);
    precise vec3 ends = (cubes.x * corners.position[0] + cubes.y * corners.position[1]) + cubes.z * corners.position[2];
    precise vec3 first = pn_edge(near[0], near[1], weights.x, weights.y);
    precise vec3 second = pn_edge(near[2], near[3], weights.y, weights.z);
    precise vec3 third = pn_edge(near[4], near[5], weights.z, weights.x);
    precise vec3 edges = (first + second) + third;
    precise vec3 result = (ends + edges) + (6.0 * weights.x * weights.y * weights.z) * middle;
    return result;
}

// The quadratic normal's control in the middle of an edge.
precise vec3 pn_edge_normal(Corners corners, uint from, uint to)
{
    precise vec3 along = corners.position[to] - corners.position[from];
    precise vec3 sum = corners.normal[from] + corners.normal[to];
    precise float turn = 2.0 * precise_dot(along, sum) / max(precise_dot(along, along), 1.17549435e-38);
    precise vec3 result = sum - turn * along;
    return unit_vector(result);
}

precise vec3 pn_normal(Corners corners, vec4 weights)
{
    precise vec3 ends = ((weights.x * weights.x) * corners.normal[0] + (weights.y * weights.y) * corners.normal[1]) + (weights.z * weights.z) * corners.normal[2];
    precise vec3 first = (weights.x * weights.y) * pn_edge_normal(corners, 0u, 1u);
    precise vec3 second = (weights.y * weights.z) * pn_edge_normal(corners, 1u, 2u);
    precise vec3 third = (weights.z * weights.x) * pn_edge_normal(corners, 2u, 0u);
    precise vec3 result = ends + ((first + second) + third);
    return result;
}

TablePoint substitute_point(Corners corners, vec4 weights)
{
    vec3 position = EVALUATE == EVALUATE_FLAT ? mixed(corners.position, weights)
        : (EVALUATE == EVALUATE_PHONG ? phong_point(corners, weights) : pn_point(corners, weights));
    vec3 normal = EVALUATE == EVALUATE_PN ? pn_normal(corners, weights) : mixed(corners.normal, weights);
    return TablePoint(position, unit_vector(normal));
}
#endif
