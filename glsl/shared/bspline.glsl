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

// A unit vector along a x b, or 0 where they span no plane.
precise vec3 unit_normal(vec3 a, vec3 b)
{
    precise vec3 result = unit_vector(precise_cross(scaled(a), scaled(b)));
    return result;
}
#endif
