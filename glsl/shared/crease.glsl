// Weights across a semi-sharp crease along an edge of a regular patch (Niessner, Loop and Greiner 2012); planish_subdiv's
// patch::crease_basis derives them.
#ifndef PLANISH_CREASE
#define PLANISH_CREASE
#include "bspline.glsl"

// The weights of four rows that stand for others: `w` of q0 to q3, each a sum of the rows p0 to p3.
precise vec4 weights_of(vec4 w, vec4 q0, vec4 q1, vec4 q2, vec4 q3)
{
    precise vec4 result = ((w.x * q0 + w.y * q1) + w.z * q2) + w.w * q3;
    return result;
}

// Basis times 6 and derivative times 2, as cubic_basis, at distance t from a crease of sharpness > 0 along row 1.
void crease_basis(float t, float sharpness, out precise vec4 n, out precise vec4 d)
{
    uint steps = uint(sharpness);
    float rest = sharpness - float(steps);
    float scale = float(1u << steps);
    precise float local = t * scale;
    vec4 bn;
    vec4 bd;
    if (local >= 1.0) {
        // Infinitely sharp: row 0 is the reflection 2 p1 - p2.
        precise float s = 1.0 - t;
        cubic_basis(t, s, bn, bd);
        precise vec4 reflected = vec4(0.0, bn.y + 2.0 * bn.x, bn.z - bn.x, bn.w);
        precise vec4 slope = vec4(0.0, bd.y + 2.0 * bd.x, bd.z - bd.x, bd.w);
        n = reflected;
        d = slope;
        return;
    }
    // The rows after `steps` steps in which row 1 stays where it is.
    float near = 1.0 / scale;
    float cube = near * near * near;
    vec4 p0 = vec4(near, 1.0 - near, 0.0, 0.0);
    vec4 p1 = vec4(0.0, 1.0, 0.0, 0.0);
    vec4 p2 = vec4(0.0, 1.0 - near, near, 0.0);
    vec4 p3 = vec4(0.0, (1.0 - 2.0 * near) + cube, 2.0 * (near - cube), cube);
    if (rest > 0.0) {
        // The last step, of which the smooth rule has a part.
        precise vec4 smoothed = 0.125 * (p0 + p2) + 0.75 * p1;
        precise vec4 q0 = 0.5 * (p0 + p1);
        precise vec4 q1 = rest * p1 + (1.0 - rest) * smoothed;
        precise vec4 q2 = 0.5 * (p1 + p2);
        precise vec4 q3 = 0.125 * (p1 + p3) + 0.75 * p2;
        precise vec4 q4 = 0.5 * (p2 + p3);
        scale *= 2.0;
        local *= 2.0;
        bool is_second = local >= 1.0;
        local -= is_second ? 1.0 : 0.0;
        p0 = is_second ? q1 : q0;
        p1 = is_second ? q2 : q1;
        p2 = is_second ? q3 : q2;
        p3 = is_second ? q4 : q3;
    }
    precise float rest_of_local = 1.0 - local;
    cubic_basis(local, rest_of_local, bn, bd);
    n = weights_of(bn, p0, p1, p2, p3);
    d = weights_of(bd, p0, p1, p2, p3) * scale;
}

// The same where row 2 is on the crease and row 3 beyond it; t is the distance from it still.
void reversed_crease_basis(float t, float sharpness, out precise vec4 n, out precise vec4 d)
{
    precise vec4 forward;
    precise vec4 slope;
    crease_basis(t, sharpness, forward, slope);
    n = forward.wzyx;
    d = -slope.wzyx;
}
#endif
