// Control points of Gregory patches from spokes, and their evaluation (Loop et al. 2009). In f64: crates/subdiv/src/gregory/.
#ifndef PLANISH_GREGORY
#define PLANISH_GREGORY
#extension GL_EXT_control_flow_attributes : require
#include "scene.glsl"
#include "spacing.glsl"

uint gregory_kind(GregoryFace face) { return gregory_kind(face.flags); }
uint gregory_part(GregoryFace face) { return (face.flags & 7u) - GREGORY_TRIANGLE; }
bool gregory_is_sharp(GregoryFace face, uint edge) { return (face.flags >> (4u + edge) & 1u) != 0u; }

// The curve along an edge and the field across it, to the left, as cubics in Bezier form: what the patches on both sides share.
struct EdgeFields {
    vec3 curve[4];
    vec3 across[4];
};

// From the seat of limit `from` along the edge of two spokes to the seat of limit `to`.
EdgeFields edge_fields(SceneTables scene, uint from, uint first, uint last, uint to)
{
    EdgeFields result;
    result.curve[0] = scene.v.limits.v[from].position;
    result.curve[1] = scene.v.spokes.v[first].edge;
    result.curve[2] = scene.v.spokes.v[last].edge;
    result.curve[3] = scene.v.limits.v[to].position;
    result.across[0] = scene.v.spokes.v[first].across;
    result.across[1] = scene.v.spokes.v[first].beside;
    result.across[2] = -scene.v.spokes.v[last].beside;
    result.across[3] = -scene.v.spokes.v[last].across;
    return result;
}

// Equation (6): the face point beside the edge point `edge` of a corner at p; `far` is the edge's other one, r points into the face.
precise vec3 face_point(float degree, vec3 p, float cosine, vec3 edge, float far_cosine, vec3 far, vec3 r)
{
    precise vec3 sum = (far_cosine * p + ((degree - 2.0 * cosine) - far_cosine) * edge) + ((2.0 * cosine) * far + r);
    precise vec3 result = sum / degree;
    return result;
}

// Control point i of a quad or a triangle: p, e+, e-, f+, f- of each corner.
vec3 corner_point(SceneTables scene, GregoryFace face, uint i, uint corners)
{
    uint corner = i / 5u;
    uint which = i % 5u;
    uint next = corner + 1u == corners ? 0u : corner + 1u;
    uint previous = corner == 0u ? corners - 1u : corner - 1u;
    vec3 p = scene.v.limits.v[face.limits[corner]].position;
    if (which == 0u) {
        return p;
    }
    bool is_out = which == 1u || which == 3u;
    uint spoke = is_out ? face.first[corner] : face.last[previous];
    vec3 edge = scene.v.spokes.v[spoke].edge;
    if (which < 3u) {
        return edge;
    }
    uint far = is_out ? face.last[corner] : face.first[previous];
    vec3 beside = scene.v.spokes.v[spoke].beside;
    return face_point(corners == 3u ? 4.0 : 3.0, p, face.cosines[corner], edge, face.cosines[is_out ? next : previous],
                      scene.v.spokes.v[far].edge, is_out ? beside : -beside);
}

precise vec3 middle_of(vec3 a, vec3 b, vec3 c, vec3 d)
{
    precise vec3 result = (0.125 * a + 0.125 * d) + (0.375 * b + 0.375 * c);
    return result;
}

// Point i of the half of a cubic at its first end.
vec3 half_cubic(vec3 p[4], uint i)
{
    if (i == 3u) {
        return middle_of(p[0], p[1], p[2], p[3]);
    }
    precise vec3 one = 0.5 * p[0] + 0.5 * p[1];
    precise vec3 two = (0.25 * p[0] + 0.25 * p[2]) + 0.5 * p[1];
    return i == 0u ? p[0] : (i == 1u ? one : two);
}

// Derivatives into the face along an edge: equations (2) to (5).
void inward_fields(EdgeFields edge, float c0, float c1, out vec3 inward[4])
{
    precise vec3 u0 = 3.0 * (edge.curve[1] - edge.curve[0]);
    precise vec3 u1 = 3.0 * (edge.curve[2] - edge.curve[1]);
    precise vec3 u2 = 3.0 * (edge.curve[3] - edge.curve[2]);
    precise vec3 v0 = edge.across[0] + c0 * u0;
    precise vec3 v1 = edge.across[1] + ((2.0 * c0) * u1 - c1 * u0) / 3.0;
    precise vec3 v2 = edge.across[2] + (c0 * u2 - (2.0 * c1) * u1) / 3.0;
    precise vec3 v3 = edge.across[3] - c1 * u2;
    inward = vec3[4](v0, v1, v2, v3);
}

precise vec3 third_step(vec3 point, vec3 vector, float scale)
{
    precise vec3 result = point + (scale * vector) / 3.0;
    return result;
}

// The inner edge of a face of more than four sides from the middle of an outer edge to the centre.
EdgeFields inner_edge(SceneTables scene, EdgeFields outer, float c0, float c1, uint centre, uint spoke)
{
    vec3 inward[4];
    inward_fields(outer, c0, c1, inward);
    EdgeFields result;
    result.curve[0] = middle_of(outer.curve[0], outer.curve[1], outer.curve[2], outer.curve[3]);
    // A part has derivatives of half the size of the whole face's.
    result.curve[1] = third_step(result.curve[0], middle_of(inward[0], inward[1], inward[2], inward[3]), 0.5);
    result.curve[2] = scene.v.spokes.v[spoke].edge;
    result.curve[3] = scene.v.limits.v[centre].position;
    // To the left lies the outer edge, backwards.
    precise vec3 back = 0.375 * ((outer.curve[0] - outer.curve[3]) + (outer.curve[1] - outer.curve[2]));
    result.across[0] = back;
    result.across[3] = -scene.v.spokes.v[spoke].across;
    precise vec3 linear = (2.0 * result.across[0] + result.across[3]) / 3.0;
    result.across[1] = linear;
    result.across[2] = -scene.v.spokes.v[spoke].beside;
    return result;
}

EdgeFields turned(EdgeFields edge)
{
    EdgeFields result;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        result.curve[i] = edge.curve[3u - i];
        result.across[i] = -edge.across[3u - i];
    }
    return result;
}

// Edges of the part of a face of more than four sides at a corner, whose corners are that one, the middle of the next edge, the
// centre and the middle of the edge before. Edges 0 and 3 are the face's whole outer ones: of the next its first half, of that before
// its second half bounds the part.
EdgeFields ngon_edge(SceneTables scene, GregoryFace face, uint edge)
{
    bool is_after = edge < 2u;
    EdgeFields outer = is_after ? edge_fields(scene, face.limits[1], face.first[1], face.last[1], face.limits[2])
                                : edge_fields(scene, face.limits[0], face.first[0], face.last[0], face.limits[1]);
    if (edge == 0u || edge == 3u) {
        return outer;
    }
    EdgeFields inner = inner_edge(scene, outer, face.cosines[is_after ? 1 : 0], face.cosines[is_after ? 2 : 1], face.limits[3],
                                  face.first[is_after ? 3 : 2]);
    if (is_after) {
        return inner;
    }
    return turned(inner);
}

// Control point i of such a part.
vec3 ngon_point(SceneTables scene, GregoryFace face, uint i)
{
    uint corner = i / 5u;
    uint which = i % 5u;
    // The edge that the point lies along.
    bool is_out = which == 1u || which == 3u;
    uint edge = is_out ? corner : (corner + 3u) & 3u;
    if (which == 0u) {
        edge = corner == 1u ? 0u : corner;
    }
    EdgeFields own = ngon_edge(scene, face, edge);
    if (edge == 0u || edge == 3u) {
        // Seen from the corner of the cage: 0 is its own end of the half edge, 3 the middle.
        EdgeFields seen = own;
        if (edge == 3u) {
            seen = turned(own);
        }
        bool is_middle = corner == 1u || corner == 3u;
        uint place = which == 0u ? (is_middle ? 3u : 0u) : (is_middle ? 2u : 1u);
        vec3 on_curve = half_cubic(seen.curve, place);
        if (which < 3u) {
            return on_curve;
        }
        vec3 inward[4];
        inward_fields(own, face.cosines[edge == 0u ? 1 : 0], face.cosines[edge == 0u ? 2 : 1], inward);
        if (edge == 3u) {
            inward = vec3[4](inward[3], inward[2], inward[1], inward[0]);
        }
        return third_step(on_curve, half_cubic(inward, place), 0.5);
    }
    // Edge 1 runs to the centre, edge 2 from it.
    bool is_at_centre = corner == 2u;
    uint near = is_out ? 0u : 3u;
    uint next = is_out ? 1u : 2u;
    if (which == 0u) {
        return own.curve[0];
    }
    if (which < 3u) {
        return own.curve[next];
    }
    float centre = face.cosines[3];
    return face_point(3.0, own.curve[near], is_at_centre ? centre : 0.0, own.curve[next], is_at_centre ? 0.0 : centre,
                      own.curve[3u - next], own.across[next]);
}

// Cubic Bernstein polynomials, times 1, and derivatives, divided by 3.
void bernstein(float t, float s, out precise vec4 n, out precise vec4 d)
{
    precise float tt = t * t;
    precise float ss = s * s;
    precise float ts = t * s;
    n = vec4(ss * s, 3.0 * (ss * t), 3.0 * (tt * s), tt * t);
    d = vec4(-ss, ss - 2.0 * ts, 2.0 * ts - tt, tt);
}

// Sum of four weighted vectors in an order that reversing them leaves alone.
precise vec3 weigh_ends(vec3 a, vec3 b, vec3 c, vec3 d, vec4 w)
{
    precise vec3 outer = a * w.x + d * w.w;
    precise vec3 inner = b * w.y + c * w.z;
    precise vec3 sum = outer + inner;
    return sum;
}

// The normal of both sides of an edge: by the derivative along it, in Bezier form over 3, and the field across.
vec3 edge_normal(vec3 u0, vec3 u1, vec3 u2, vec3 across[4], Parameter at)
{
    precise vec4 n;
    precise vec4 d;
    bernstein(at.t, at.s, n, d);
    precise float ss = at.s * at.s;
    precise float tt = at.t * at.t;
    precise float ts = 2.0 * (at.t * at.s);
    precise vec3 along = (u0 * ss + u2 * tt) + u1 * ts;
    return unit_normal(along, weigh_ends(across[0], across[1], across[2], across[3], n));
}

// Position on the curve along an edge, and the normal of both sides there.
void evaluate_edge(EdgeFields edge, Parameter at, out vec3 position, out vec3 normal)
{
    precise vec4 n;
    precise vec4 d;
    bernstein(at.t, at.s, n, d);
    position = weigh_ends(edge.curve[0], edge.curve[1], edge.curve[2], edge.curve[3], n);
    precise vec3 u0 = edge.curve[1] - edge.curve[0];
    precise vec3 u1 = edge.curve[2] - edge.curve[1];
    precise vec3 u2 = edge.curve[3] - edge.curve[2];
    normal = edge_normal(u0, u1, u2, edge.across, at);
}

// (a p + b q) / (a + b), p where both are 0.
precise vec3 blend(float a, vec3 p, float b, vec3 q)
{
    precise float total = a + b;
    precise vec3 result = (a * p + b * q) / total;
    return total == 0.0 ? p : result;
}

// What the blend changes by with a; with b by -a / b of it.
precise vec3 blend_slope(float a, vec3 p, float b, vec3 q)
{
    precise float total = a + b;
    precise vec3 result = (p - q) * (b / (total * total));
    return total == 0.0 ? vec3(0.0) : result;
}
#endif
