// Whether nothing can be seen of a Gregory patch: it lies outside of the view, or every triangle that it can be tessellated into shows
// its back. CPU twin and derivation: crates/render/src/gregory_visibility.rs.
#ifndef PLANISH_GREGORY_VISIBILITY
#define PLANISH_GREGORY_VISIBILITY
#include "gregory_points.glsl"

// What a patch is off the Bezier patch of its mean face points at most, over the largest distance between two face points of a corner.
struct DeviationBounds {
    float position;
    float tangent; // along u or v
    float row;     // tangents of rows along outer edges, over the distance from the edge
    float change;  // second derivatives of rows beside inner edges
};
const DeviationBounds QUAD_DEVIATION = DeviationBounds(0.072, 1.125, 4.5, 0.0);
const DeviationBounds THIRD_DEVIATION = DeviationBounds(0.071, 0.53, 1.5, 4.0);
// Above the squared length of a scaled offset from the eye, whose components are at most 1.
const float MOST_SQUARE = 4.0;

precise vec3 mean(vec3 a, vec3 b)
{
    precise vec3 result = 0.5 * a + 0.5 * b;
    return result;
}

precise vec3 near_corner(vec3 corner, vec3 edge)
{
    precise vec3 result = 0.25 * corner + 0.75 * edge;
    return result;
}

// What is known of the face points of a patch: how far those of a corner are apart, and the crosses of that with its middle.
struct Apart {
    vec3 across[4];
    float most;    // the largest distance
    float product; // of two corners, with the middle
};

Apart apart_of(vec3 p[20], uint corners, vec3 middle)
{
    Apart result;
    vec3 apart[4];
    float square = 0.0;
    result.product = 0.0;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        precise vec3 between = p[5u * i + 3u] - p[5u * i + 4u];
        apart[i] = i < corners ? between : vec3(0.0);
        square = max(square, precise_dot(apart[i], apart[i]));
        result.across[i] = precise_cross(apart[i], middle);
        [[unroll]] for (uint j = 0u; j < i; ++j) {
            result.product = max(result.product, abs(precise_dot(apart[j], result.across[i])));
        }
    }
    result.most = sqrt(square);
    return result;
}

// The largest product of the middle, a unit tangent and what face points are apart.
float tangent_product(Apart apart, vec3 tangent)
{
    float result = 0.0;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        result = max(result, abs(precise_dot(tangent, apart.across[i])));
    }
    return result;
}

// `u_product` and `v_product` are the largest of those of all unit tangents.
Deviation deviation_of(Apart apart, DeviationBounds bounds, TangentBounds u, TangentBounds v, float u_product, float v_product,
                       Grain grain, Scale scale, float square_radius)
{
    precise float position = bounds.position * apart.most;
    precise float spread = (sqrt(square_radius) + position) + 2.0 * scale.eye_rounding;
    precise float area = u.least * v.least;
    precise float tangent = ((bounds.tangent * apart.most) * (u.least + v.least)) / area;
    precise float of_u = (u_product + spread * apart.most) / v.least;
    precise float of_v = (v_product + spread * apart.most) / u.least;
    precise float both = (apart.product + (spread * apart.most) * apart.most) / area;
    precise float turn = bounds.change * grain.skew;
    precise float slide = bounds.row * grain.reach;
    precise float u_turn = max(turn, slide * min(u.most / u.least, 2.0));
    precise float v_turn = max(turn, slide * min(v.most / v.least, 2.0));
    precise float linear = bounds.tangent * (of_u + of_v) + max(u_turn * of_u, v_turn * of_v);
    precise float square = bounds.tangent * (bounds.tangent + max(u_turn, v_turn));
    precise float product = linear + square * both;
    return Deviation(position, tangent, product);
}

// The largest product of the middle, a unit tangent and a second derivative in the same direction.
precise float bend_product(vec3 b[16], int step, int row, vec3 along[12], vec3 middle)
{
    float most = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        int at = i / 2 * row + i % 2 * step;
        precise vec3 bend = (b[at + 2 * step] - b[at + step]) - (b[at + step] - b[at]);
        vec3 across = precise_cross(bend, middle);
        [[unroll]] for (int j = 0; j < 12; ++j) {
            most = max(most, abs(precise_dot(along[j], across)));
        }
    }
    precise float result = 6.0 * most;
    return result;
}

// Whether all triangles of a quad show their back; `p` scaled.
bool is_gregory_quad_turned(vec3 p[20], EmitView view, Grain grain, Scale scale)
{
    vec3 b[16] = vec3[16](
        p[0], p[1], p[7], p[5],
        p[2], mean(p[3], p[4]), mean(p[8], p[9]), p[6],
        p[16], mean(p[18], p[19]), mean(p[13], p[14]), p[12],
        p[15], p[17], p[11], p[10]);
    precise vec3 middle = 0.25 * ((b[0] + b[3]) + (b[12] + b[15])) - scale.eye;
    float square_radius = 0.0;
    [[unroll]] for (int i = 0; i < 16; ++i) {
        precise vec3 around = (b[i] - scale.eye) - middle;
        square_radius = max(square_radius, precise_dot(around, around));
    }
    vec3 along_u[12];
    vec3 along_v[12];
    TangentBounds u = tangents_of(b, 1, 4, along_u);
    TangentBounds v = tangents_of(b, 4, 1, along_v);
    Apart apart = apart_of(p, 4u, middle);
    float u_product = 0.0;
    float v_product = 0.0;
    [[unroll]] for (int i = 0; i < 12; ++i) {
        u_product = max(u_product, tangent_product(apart, along_u[i]));
        v_product = max(v_product, tangent_product(apart, along_v[i]));
    }
    Deviation deviation = deviation_of(apart, QUAD_DEVIATION, u, v, u_product, v_product, grain, scale, square_radius);
    precise float spread = (sqrt(square_radius) + deviation.position) + 2.0 * scale.eye_rounding;
    precise float rest = spread + (sqrt(precise_dot(middle, middle)) + spread) * deviation.tangent;
    precise float u_bend = (bend_product(b, 1, 4, along_u, middle) + rest * u.change) / v.least;
    precise float v_bend = (bend_product(b, 4, 1, along_v, middle) + rest * v.change) / u.least;
    precise float lost = deviation.product + grain.skew * max(u_bend, v_bend);
    deviation.product = lost;
    grain.skew = 0.0;
    float product = least_product(along_u, along_v, middle);
    return exceeds_slack(product, u, v, view, grain, scale, middle, square_radius, deviation);
}

// Place in a triangular net of Bezier points of a degree, by the exponents of the second and the third corner's coordinate.
uint net_place(uint degree, uint second, uint third)
{
    return third * (2u * degree + 3u - third) / 2u + second;
}

// Changes over the neighbours of a place of a net of one degree more: along the line from the first corner to another, and along the
// line through the middle to the other edge.
precise vec3 along_edge(vec3 own, vec3 towards)
{
    precise vec3 result = 0.5 * (towards - own);
    return result;
}

precise vec3 along_middle(vec3 own, vec3 towards, vec3 other)
{
    precise vec3 result = ((towards - own) + (towards - other)) / 6.0;
    return result;
}

// Of a quartic triangle whose first corner the third is at: along u, towards the second corner, or along v, towards the third. Makes
// unit vectors of the tangents along one of its edges, and of those through its middle: what lies between is a mean of them.
TangentBounds third_tangents(vec3 net[15], bool is_u, out vec3 tangents[20])
{
    [[dont_unroll]] for (uint k = 0u; k < 4u; ++k) {
        [[dont_unroll]] for (uint j = 0u; j < 4u - k; ++j) {
            uint at = net_place(3u, j, k);
            vec3 own = net[net_place(4u, j, k)];
            vec3 second = net[net_place(4u, j + 1u, k)];
            vec3 third = net[net_place(4u, j, k + 1u)];
            vec3 towards = is_u ? second : third;
            tangents[at] = along_edge(own, towards);
            tangents[10u + at] = along_middle(own, towards, is_u ? third : second);
        }
    }
    float change = 0.0;
    [[dont_unroll]] for (uint first = 0u; first < 20u; first += 10u) {
        [[dont_unroll]] for (uint k = 0u; k < 3u; ++k) {
            [[dont_unroll]] for (uint j = 0u; j < 3u - k; ++j) {
                vec3 own = tangents[first + net_place(3u, j, k)];
                vec3 second = tangents[first + net_place(3u, j + 1u, k)];
                vec3 third = tangents[first + net_place(3u, j, k + 1u)];
                vec3 towards = is_u ? second : third;
                vec3 edge = along_edge(own, towards);
                vec3 middle = along_middle(own, towards, is_u ? third : second);
                change = max(change, max(precise_dot(edge, edge), precise_dot(middle, middle)));
            }
        }
    }
    float least = 3.402823e38;
    float most = 0.0;
    [[dont_unroll]] for (uint i = 0u; i < 20u; ++i) {
        float square = precise_dot(tangents[i], tangents[i]);
        least = min(least, square);
        most = max(most, square);
        precise vec3 unit = tangents[i] / sqrt(max(square, LEAST_FLOAT));
        tangents[i] = unit;
    }
    precise float shortest = 4.0 * sqrt(least);
    precise float longest = 4.0 * sqrt(most);
    precise float second_change = 12.0 * sqrt(change);
    return TangentBounds(shortest, longest, second_change);
}

// Whether all triangles of the third of a triangle at its first corner show their back; `p` scaled.
bool is_gregory_third_turned(vec3 p[20], EmitView view, Grain grain, Scale scale)
{
    vec3 net[15] = vec3[15](
        p[0], near_corner(p[0], p[1]), mean(p[1], p[7]), near_corner(p[5], p[7]), p[5],
        near_corner(p[0], p[2]), mean(p[3], p[4]), mean(p[8], p[9]), near_corner(p[5], p[6]),
        mean(p[2], p[11]), mean(p[13], p[14]), mean(p[6], p[12]),
        near_corner(p[10], p[11]), near_corner(p[10], p[12]),
        p[10]);
    precise vec3 middle = ((p[0] + p[5]) + p[10]) / 3.0 - scale.eye;
    float square_radius = 0.0;
    [[dont_unroll]] for (uint i = 0u; i < 15u; ++i) {
        precise vec3 around = (net[i] - scale.eye) - middle;
        square_radius = max(square_radius, precise_dot(around, around));
    }
    vec3 along_u[20];
    vec3 along_v[20];
    TangentBounds u = third_tangents(net, true, along_u);
    TangentBounds v = third_tangents(net, false, along_v);
    Apart apart = apart_of(p, 3u, middle);
    float u_product = 0.0;
    float v_product = 0.0;
    float product = 3.402823e38;
    [[dont_unroll]] for (uint j = 0u; j < 20u; ++j) {
        u_product = max(u_product, tangent_product(apart, along_u[j]));
        v_product = max(v_product, tangent_product(apart, along_v[j]));
        vec3 across_v = precise_cross(along_v[j], middle);
        [[dont_unroll]] for (uint i = 0u; i < 20u; ++i) {
            product = min(product, precise_dot(along_u[i], across_v));
        }
    }
    Deviation deviation = deviation_of(apart, THIRD_DEVIATION, u, v, u_product, v_product, grain, scale, square_radius);
    return exceeds_slack(product, u, v, view, grain, scale, middle, square_radius, deviation);
}

// Whether nothing of a Gregory patch can be seen. It lies in the convex hull of its control points. Where the object is displaced it
// is seen from behind.
bool is_gregory_unseen(SceneTables scene, Object object, GregoryFace face, uint place, EmitView view, Grain grain, bool cull_back)
{
    vec3 p[20];
    gregory_points(scene, object, face, place, p);
    float largest_offset = 0.0;
    float largest = 0.0;
    [[dont_unroll]] for (uint i = 0u; i < 20u; ++i) {
        precise vec3 offset = p[i] - view.eye;
        largest_offset = max(largest_offset, largest_component(offset));
        largest = max(largest, largest_component(p[i]));
    }
    Scale scale = scale_of(view, 1.0, largest_offset, largest);
    precise float margin = object.displacement * scale.factor;
    uint planes = 31u;
    bool is_computed = true; // all are numbers
    [[dont_unroll]] for (uint i = 0u; i < 20u; ++i) {
        precise vec3 scaled_point = p[i] * scale.factor;
        precise vec3 offset = scaled_point - scale.eye;
        p[i] = scaled_point;
        planes &= outside_planes(offset, view, scale, margin);
        is_computed = is_computed && precise_dot(offset, offset) < MOST_SQUARE;
    }
    bool is_unseen = planes != 0u;
    bool is_tested = cull_back && is_computed && object.displacement == 0.0 && !is_unseen;
    bool is_triangle = gregory_kind(face) == GREGORY_TRIANGLE;
    for (bool is_open = is_tested && !is_triangle; is_open; is_open = false) {
        is_unseen = is_gregory_quad_turned(p, view, grain, scale);
    }
    for (bool is_open = is_tested && is_triangle; is_open; is_open = false) {
        is_unseen = is_gregory_third_turned(p, view, grain, scale);
    }
    return is_unseen;
}
#endif
