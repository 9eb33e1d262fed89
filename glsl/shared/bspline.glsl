// Bicubic B-splines by FAS section 5.1: reversal invariant, so that both sides of an edge get the same bits from the same
// control points. `s` is 1 - t, passed on its own to keep the symmetry.
#ifndef PLANISH_BSPLINE
#define PLANISH_BSPLINE
// Basis times 6 and derivative times 2.
void cubic_basis(float t, float s, out precise vec4 n, out precise vec4 d)
{
    precise float tt = t * t;
    precise float ss = s * s;
    precise float ts = t * s;
    precise float ttt = tt * t;
    precise float sss = ss * s;
    precise float tts = tt * s;
    precise float sst = ss * t;
    n.x = sss;
    n.y = (4.0 * sss + ttt) + (12.0 * sst + 6.0 * tts);
    n.z = (4.0 * ttt + sss) + (12.0 * tts + 6.0 * sst);
    n.w = ttt;
    d.x = -ss;
    d.y = -tt - 4.0 * ts;
    d.z = ss + 4.0 * ts;
    d.w = tt;
}

// Sum of four weighted points, in the order that reversing the curve leaves alone.
precise vec3 weigh(vec3 p0, vec3 p1, vec3 p2, vec3 p3, vec4 w)
{
    precise vec3 outer = p0 * w.x + p2 * w.z;
    precise vec3 inner = p1 * w.y + p3 * w.w;
    precise vec3 sum = outer + inner;
    return sum;
}

// Sum of 16 points, row by row, weighted by products of weights along u and v. The order of the sum is one that no turn and
// no reflection of the patch changes, nor the step to the next patch across an edge: there one row of weights is 0, and what
// is left is added as the neighbour does. So all patches at an edge or a corner get the same bits (FAS section 5.2).
precise vec3 weigh_patch(vec3 p[16], vec4 nu, vec4 nv)
{
    // Points whose rows, and columns, are an even number apart: four at a time.
    precise vec3 even_even = (p[0] * (nu.x * nv.x) + p[10] * (nu.z * nv.z)) + (p[2] * (nu.z * nv.x) + p[8] * (nu.x * nv.z));
    precise vec3 odd_even = (p[3] * (nu.w * nv.x) + p[9] * (nu.y * nv.z)) + (p[1] * (nu.y * nv.x) + p[11] * (nu.w * nv.z));
    precise vec3 even_odd = (p[12] * (nu.x * nv.w) + p[6] * (nu.z * nv.y)) + (p[14] * (nu.z * nv.w) + p[4] * (nu.x * nv.y));
    precise vec3 odd_odd = (p[15] * (nu.w * nv.w) + p[5] * (nu.y * nv.y)) + (p[13] * (nu.y * nv.w) + p[7] * (nu.w * nv.y));
    precise vec3 sum = (even_even + odd_odd) + (odd_even + even_odd);
    return sum;
}

// The same with three pairs of weights, each point being looked at once: position times 36, and tangents along u and v times 12.
void weigh_patch_and_tangents(vec3 p[16], vec4 nu, vec4 du, vec4 nv, vec4 dv, out precise vec3 position, out precise vec3 along_u,
                              out precise vec3 along_v)
{
    precise vec3 even_even_p = (p[0] * (nu.x * nv.x) + p[10] * (nu.z * nv.z)) + (p[2] * (nu.z * nv.x) + p[8] * (nu.x * nv.z));
    precise vec3 even_even_u = (p[0] * (du.x * nv.x) + p[10] * (du.z * nv.z)) + (p[2] * (du.z * nv.x) + p[8] * (du.x * nv.z));
    precise vec3 even_even_v = (p[0] * (nu.x * dv.x) + p[10] * (nu.z * dv.z)) + (p[2] * (nu.z * dv.x) + p[8] * (nu.x * dv.z));
    precise vec3 odd_even_p = (p[3] * (nu.w * nv.x) + p[9] * (nu.y * nv.z)) + (p[1] * (nu.y * nv.x) + p[11] * (nu.w * nv.z));
    precise vec3 odd_even_u = (p[3] * (du.w * nv.x) + p[9] * (du.y * nv.z)) + (p[1] * (du.y * nv.x) + p[11] * (du.w * nv.z));
    precise vec3 odd_even_v = (p[3] * (nu.w * dv.x) + p[9] * (nu.y * dv.z)) + (p[1] * (nu.y * dv.x) + p[11] * (nu.w * dv.z));
    precise vec3 even_odd_p = (p[12] * (nu.x * nv.w) + p[6] * (nu.z * nv.y)) + (p[14] * (nu.z * nv.w) + p[4] * (nu.x * nv.y));
    precise vec3 even_odd_u = (p[12] * (du.x * nv.w) + p[6] * (du.z * nv.y)) + (p[14] * (du.z * nv.w) + p[4] * (du.x * nv.y));
    precise vec3 even_odd_v = (p[12] * (nu.x * dv.w) + p[6] * (nu.z * dv.y)) + (p[14] * (nu.z * dv.w) + p[4] * (nu.x * dv.y));
    precise vec3 odd_odd_p = (p[15] * (nu.w * nv.w) + p[5] * (nu.y * nv.y)) + (p[13] * (nu.y * nv.w) + p[7] * (nu.w * nv.y));
    precise vec3 odd_odd_u = (p[15] * (du.w * nv.w) + p[5] * (du.y * nv.y)) + (p[13] * (du.y * nv.w) + p[7] * (du.w * nv.y));
    precise vec3 odd_odd_v = (p[15] * (nu.w * dv.w) + p[5] * (nu.y * dv.y)) + (p[13] * (nu.y * dv.w) + p[7] * (nu.w * dv.y));
    position = (even_even_p + odd_odd_p) + (odd_even_p + even_odd_p);
    along_u = (even_even_u + odd_odd_u) + (odd_even_u + even_odd_u);
    along_v = (even_even_v + odd_odd_v) + (odd_even_v + even_odd_v);
}

// Cross product whose operations are all kept as written.
precise vec3 precise_cross(vec3 a, vec3 b)
{
    precise vec3 ab = a.yzx * b.zxy;
    precise vec3 ba = a.zxy * b.yzx;
    precise vec3 result = ab - ba;
    return result;
}

// A vector scaled to a largest component of 1, or 0: products of huge or tiny ones leave f32's range.
precise vec3 scaled(vec3 a)
{
    precise float largest = max(max(max(abs(a.x), abs(a.y)), abs(a.z)), 1.17549435e-38);
    precise vec3 result = a / largest;
    return result;
}

// A vector of length 1, or 0.
precise vec3 unit_vector(vec3 a)
{
    precise vec3 vector = scaled(a);
    precise float square = (vector.x * vector.x + vector.y * vector.y) + vector.z * vector.z;
    precise vec3 result = vector / sqrt(max(square, 1.17549435e-38));
    return result;
}

// Where all terms of a sum are 0 its sign depends on what was added: not any more.
precise vec3 without_sign_of_zero(vec3 a)
{
    precise vec3 result = a + 0.0;
    return result;
}

// A unit vector along a x b, or 0 where they span no plane.
precise vec3 unit_normal(vec3 a, vec3 b)
{
    precise vec3 result = unit_vector(precise_cross(scaled(a), scaled(b)));
    return result;
}
#endif
