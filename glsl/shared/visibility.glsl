// Whether nothing can be seen of a patch: it lies outside of the view, or every triangle that it can be tessellated into
// shows its back. CPU twin and derivation: crates/render/src/visibility.rs. Conservative: in doubt a patch is seen.
//
// Every answer of "unseen" comes from comparisons that hold for no NaN: coordinates that overflow keep their patch.
#ifndef PLANISH_VISIBILITY
#define PLANISH_VISIBILITY
// Loops are unrolled: with constant indices all arrays stay in registers.
#extension GL_EXT_control_flow_attributes : require
#include "bspline.glsl"
#include "tables.glsl"

// The smallest normal float.
const float LEAST_FLOAT = 1.17549435e-38;
// How far the sums here and those of the draw may be off, over the largest number in them: 2^-19, 32 roundings.
const float ROUNDING = 1.9073486e-6;
// Sine of how far a patch must be turned away at least.
const float TURN_MARGIN = 1e-4;
// Length of a vector without a component above 1.
const float CUBE_DIAGONAL = 1.7320509;

// What is seen, in world space.
struct EmitView {
    vec3 eye;
    vec3 clip_x;    // a point at d from the eye has clip coordinates x = dot(clip_x, d),
    vec3 clip_y;    // y = dot(clip_y, d)
    vec3 clip_w;    // and w = dot(clip_w, d), its depth
    float near;     // depth of the near plane
    float snap;     // how far the rasterizer's grid may move a vertex, over its distance from the eye
    uint cull; // 0: nothing is left out; 1: what lies outside of the view; 2: and triangles that show their back
};

// How a patch is tessellated, in its own parameters; factors.glsl makes it.
struct Grain {
    float grain;    // 1 over the shortest side of a triangle; of an uneven patch, one with an edge that has other points than the
                    // row beside it, at least 1 over a triangle's area times the longest side
    float reach;    // of an uneven patch: how far the tip of a triangle of such an edge may be from the nearer end of its base, along it
    float skew;     // how much more a triangle of such an edge turns along with the row: x in visibility.rs
    bool is_uneven;
};

// What is not the Bezier patch that stands for it: how far points may be off, how far tangents over the shortest of them, and what the
// products lose by it.
struct Deviation {
    float position;
    float tangent;
    float product;
};
const Deviation NO_DEVIATION = Deviation(0.0, 0.0, 0.0);

precise float precise_dot(vec3 a, vec3 b)
{
    precise float result = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return result;
}

float largest_component(vec3 a)
{
    return max(max(abs(a.x), abs(a.y)), abs(a.z));
}

precise float sum_of_components(vec3 a)
{
    precise float result = (abs(a.x) + abs(a.y)) + abs(a.z);
    return result;
}

// Lengths relative to the farthest of a patch's points from the eye, so that no square overflows.
struct Scale {
    float factor;       // to relative lengths
    vec3 eye;           // scaled
    float near;         // scaled
    float rounding;     // of the patch's points, scaled
    float eye_rounding; // of the eye's place, scaled
};

// `largest_offset` of a component from the eye, `largest` component; points and lengths times `unit`.
Scale scale_of(EmitView view, float unit, float largest_offset, float largest)
{
    precise float factor = 1.0 / max(largest_offset, LEAST_FLOAT);
    precise vec3 eye = (view.eye * unit) * factor;
    precise float near = (view.near * unit) * factor;
    precise float rounding = ROUNDING * (largest * factor);
    precise float eye_rounding = ROUNDING * largest_component(eye);
    return Scale(factor, eye, near, rounding, eye_rounding);
}

// The planes that bound the view and that a point at `d` from the eye lies outside of, one bit each.
// `margin` is how far what is tested may reach beyond its points, scaled.
uint outside_planes(vec3 d, EmitView view, Scale scale, float margin)
{
    precise float x = precise_dot(view.clip_x, d);
    precise float y = precise_dot(view.clip_y, d);
    precise float w = precise_dot(view.clip_w, d);
    precise float noise = ((scale.rounding + scale.eye_rounding) + ROUNDING) + margin;
    precise float depth_noise = sum_of_components(view.clip_w) * noise;
    precise float x_noise = -(sum_of_components(view.clip_x) * noise + depth_noise);
    precise float y_noise = -(sum_of_components(view.clip_y) * noise + depth_noise);
    precise float left = w + x;
    precise float right = w - x;
    precise float bottom = w + y;
    precise float top = w - y;
    precise float beyond = w - scale.near;
    return (left < x_noise ? 1u : 0u) | (right < x_noise ? 2u : 0u) | (bottom < y_noise ? 4u : 0u)
        | (top < y_noise ? 8u : 0u) | (beyond < -depth_noise ? 16u : 0u);
}

// The planes that a point and all within `margin` of it lie outside of.
uint point_outside_planes(vec3 p, EmitView view, float margin)
{
    precise vec3 offset = p - view.eye;
    Scale scale = scale_of(view, 1.0, largest_component(offset), largest_component(p));
    precise vec3 d = p * scale.factor - scale.eye;
    precise float scaled_margin = margin * scale.factor;
    return outside_planes(d, view, scale, scaled_margin);
}

// The points of a cubic Bezier curve, times 6, from those of a B-spline.
void bezier_points(vec3 p0, vec3 p1, vec3 p2, vec3 p3, out precise vec3 b0, out precise vec3 b1, out precise vec3 b2,
                   out precise vec3 b3)
{
    b0 = (p0 + 4.0 * p1) + p2;
    b1 = 4.0 * p1 + 2.0 * p2;
    b2 = 2.0 * p1 + 4.0 * p2;
    b3 = (p1 + 4.0 * p2) + p3;
}

// Bounds on the tangents along one direction, and on the change of them: lengths.
struct TangentBounds {
    float least;
    float most;
    float change;
};

// Of Bezier points whose neighbours in the direction are `step` apart; rows across it begin `row` apart. Makes the 12
// tangents at the Bezier points unit vectors.
TangentBounds tangents_of(vec3 b[16], int step, int row, out vec3 tangents[12])
{
    float least = 3.402823e38;
    float most = 0.0;
    float change = 0.0;
    [[unroll]] for (int i = 0; i < 12; ++i) {
        int at = i / 3 * row + i % 3 * step;
        precise vec3 tangent = b[at + step] - b[at];
        precise float square = precise_dot(tangent, tangent);
        precise vec3 unit = tangent / sqrt(max(square, LEAST_FLOAT));
        tangents[i] = unit;
        least = min(least, square);
        most = max(most, square);
    }
    [[unroll]] for (int i = 0; i < 8; ++i) {
        int at = i / 2 * row + i % 2 * step;
        precise vec3 bend = (b[at + 2 * step] - b[at + step]) - (b[at + step] - b[at]);
        change = max(change, precise_dot(bend, bend));
    }
    precise float shortest = 3.0 * sqrt(least);
    precise float longest = 3.0 * sqrt(most);
    precise float second = 6.0 * sqrt(change);
    return TangentBounds(shortest, longest, second);
}

// How much of their product the triangles of a tessellation may lose against the tangents: x in visibility.rs. `error` is
// how far a corner may be off.
precise float slack_of(TangentBounds u, TangentBounds v, Grain grain, float error)
{
    precise float sides = (u.least + v.least) + (grain.is_uneven ? max(u.most, v.most) : 0.0);
    precise float noise = (((2.0 * error) * grain.grain) * sides) / (u.least * v.least);
    precise float turn = grain.skew * max(u.change / v.least, v.change / u.least);
    precise float slack = (noise + noise * noise) + (turn + TURN_MARGIN);
    return slack;
}

// Whether triangles whose corners have at least this product of their place and unit tangents show their back: the patch's points lie
// within the root of `square_radius` of `middle`.
bool exceeds_slack(float product, TangentBounds u, TangentBounds v, EmitView view, Grain grain, Scale scale, vec3 middle,
                   float square_radius, Deviation deviation)
{
    precise float radius = sqrt(square_radius) + deviation.position;
    precise float farthest = sqrt(precise_dot(middle, middle)) + radius;
    precise float error = scale.rounding + farthest * view.snap;
    precise float slack = slack_of(u, v, grain, error) * (1.0 + deviation.tangent);
    precise float least = ((radius + farthest * slack) + 2.0 * scale.eye_rounding) + deviation.product;
    return product > least;
}

// The least product of a place and unit tangents.
float least_product(vec3 along_u[12], vec3 along_v[12], vec3 middle)
{
    [[unroll]] for (int i = 0; i < 12; ++i) {
        along_v[i] = precise_cross(along_v[i], middle);
    }
    float product = 3.402823e38;
    [[unroll]] for (int i = 0; i < 12; ++i) {
        [[unroll]] for (int j = 0; j < 12; ++j) {
            product = min(product, precise_dot(along_u[i], along_v[j]));
        }
    }
    return product;
}

// Bezier points of a bicubic patch, times 36, from those of a B-spline.
void bezier_patch(vec3 p[16], out vec3 b[16])
{
    vec3 row[16];
    [[unroll]] for (int i = 0; i < 4; ++i) {
        bezier_points(p[4 * i], p[4 * i + 1], p[4 * i + 2], p[4 * i + 3], row[4 * i], row[4 * i + 1], row[4 * i + 2],
                      row[4 * i + 3]);
    }
    [[unroll]] for (int i = 0; i < 4; ++i) {
        bezier_points(row[i], row[4 + i], row[8 + i], row[12 + i], b[i], b[4 + i], b[8 + i], b[12 + i]);
    }
}

precise vec3 between(vec3 a, vec3 b, float t)
{
    precise float s = 1.0 - t;
    precise vec3 result = a * s + b * t;
    return result;
}

// Value of the polar form of a cubic Bezier curve at (r, s, t).
precise vec3 blossom(vec3 b0, vec3 b1, vec3 b2, vec3 b3, float r, float s, float t)
{
    vec3 c0 = between(b0, b1, r);
    vec3 c1 = between(b1, b2, r);
    vec3 c2 = between(b2, b3, r);
    vec3 d0 = between(c0, c1, s);
    vec3 d1 = between(c1, c2, s);
    precise vec3 result = between(d0, d1, t);
    return result;
}

// The Bezier points of the part between `low` and `high` of the parameters.
void bezier_part(inout vec3 b[16], vec2 low, vec2 high)
{
    [[unroll]] for (int axis = 0; axis < 2; ++axis) {
        int step = axis == 0 ? 1 : 4;
        int row = axis == 0 ? 4 : 1;
        [[unroll]] for (int i = 0; i < 4; ++i) {
            vec3 b0 = b[i * row];
            vec3 b1 = b[i * row + step];
            vec3 b2 = b[i * row + 2 * step];
            vec3 b3 = b[i * row + 3 * step];
            float l = low[axis];
            float h = high[axis];
            b[i * row] = blossom(b0, b1, b2, b3, l, l, l);
            b[i * row + step] = blossom(b0, b1, b2, b3, l, l, h);
            b[i * row + 2 * step] = blossom(b0, b1, b2, b3, l, h, h);
            b[i * row + 3 * step] = blossom(b0, b1, b2, b3, h, h, h);
        }
    }
}

// Whether all triangles of a patch show their back: by its Bezier points, scaled; `middle` is a point of it from the eye, and
// all lie within the root of `square_radius` of it.
bool is_patch_turned(vec3 b[16], EmitView view, Grain grain, Scale scale, vec3 middle, float square_radius)
{
    vec3 along_u[12];
    vec3 along_v[12];
    TangentBounds u = tangents_of(b, 1, 4, along_u);
    TangentBounds v = tangents_of(b, 4, 1, along_v);
    float product = least_product(along_u, along_v, middle);
    return exceeds_slack(product, u, v, view, grain, scale, middle, square_radius, NO_DEVIATION);
}

// Whether nothing of a bicubic patch can be seen, by its Bezier points times 36. `displacement` is how far its points may be
// moved; such patches are seen from behind.
bool is_patch_unseen(vec3 b[16], EmitView view, Grain grain, bool cull_back, float displacement)
{
    float largest_offset = 0.0;
    float largest = 0.0;
    [[unroll]] for (int i = 0; i < 16; ++i) {
        precise vec3 offset = b[i] - 36.0 * view.eye;
        largest_offset = max(largest_offset, largest_component(offset));
        largest = max(largest, largest_component(b[i]));
    }
    Scale scale = scale_of(view, 36.0, largest_offset, largest);
    [[unroll]] for (int i = 0; i < 16; ++i) {
        precise vec3 scaled_point = b[i] * scale.factor;
        b[i] = scaled_point;
    }
    precise vec3 middle = 0.25 * ((b[0] + b[3]) + (b[12] + b[15])) - scale.eye;
    precise float margin = (36.0 * displacement) * scale.factor;
    uint planes = 31u;
    float square_radius = 0.0;
    [[unroll]] for (int i = 0; i < 16; ++i) {
        precise vec3 d = b[i] - scale.eye;
        precise vec3 around = d - middle;
        planes &= outside_planes(d, view, scale, margin);
        square_radius = max(square_radius, precise_dot(around, around));
    }
    bool is_unseen = planes != 0u;
    // A loop, not a branch: a software driver runs the body of a branch that no thread takes, but not that of a loop.
    for (bool is_open = cull_back && displacement == 0.0 && !is_unseen; is_open; is_open = false) {
        is_unseen = is_patch_turned(b, view, grain, scale, middle, square_radius);
    }
    return is_unseen;
}
#endif
