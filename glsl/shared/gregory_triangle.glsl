// Triangles of 15 points and their thirds (Loop et al. 2009, figure 4b). Included where `control_point` is declared.
#ifndef PLANISH_GREGORY_TRIANGLE
#define PLANISH_GREGORY_TRIANGLE
#include "gregory.glsl"
#include "gregory_seams.glsl"

// Barycentric coordinates of a point of a third of a triangle, which is bilinear between its corner, the middle of the next edge, the
// centre and the middle of the edge before. Both thirds at a line inside get the same bits.
precise vec3 barycentric(uint part, Parameter u, Parameter v)
{
    precise float next = 0.5 * (u.t * v.s);
    precise float previous = 0.5 * (u.s * v.t);
    precise float centre = (u.t * v.t) / 3.0;
    precise float own = (u.s * v.s + (next + previous)) + centre;
    precise float to_next = next + centre;
    precise float to_previous = previous + centre;
    precise vec3 result = part == 0u ? vec3(own, to_next, to_previous)
                                     : (part == 1u ? vec3(to_previous, own, to_next) : vec3(to_next, to_previous, own));
    return result;
}

// What a corner of a triangle adds: to the position, and to its derivatives by the coordinates of the corner, of the next one and of
// the one before. All thirds add the same, whichever pipeline draws them.
struct CornerTerms {
    vec3 position;
    vec3 by_own;
    vec3 by_next;
    vec3 by_previous;
};

// a, b and c are those coordinates; p, near and far control points along the next edge, plus and minus the face points.
CornerTerms corner_terms(float a, float b, float c, vec3 p, vec3 near, vec3 far, vec3 plus, vec3 minus)
{
    precise vec3 inner = blend(b, plus, c, minus);
    precise float both = 3.0 * ((a * b) * (a + b));
    precise float product = 12.0 * ((a * a) * (b * c));
    precise vec3 position = ((a * a) * a) * p + (both * (a * near + b * far) + product * inner);
    precise vec3 by_own = (3.0 * (a * a)) * p
        + (((9.0 * a + 6.0 * b) * (a * b)) * near + ((3.0 * b + 6.0 * a) * (b * b)) * far + (24.0 * ((a * b) * c)) * inner);
    precise vec3 next = ((3.0 * a + 6.0 * b) * (a * a)) * near + ((9.0 * b + 6.0 * a) * (a * b)) * far + (12.0 * ((a * a) * c)) * inner;
    precise vec3 previous = (12.0 * ((a * a) * b)) * inner;
    precise vec3 exact_next = next + product * blend_slope(b, plus, c, minus);
    precise vec3 exact_previous = previous + product * blend_slope(c, minus, b, plus);
    return CornerTerms(position, by_own, EXACT_NORMALS ? exact_next : next, EXACT_NORMALS ? exact_previous : previous);
}

precise vec3 sum_of(vec3 a, vec3 b, vec3 c)
{
    precise vec3 result = (a + b) + c;
    return result;
}

precise vec3 difference(vec3 a, vec3 b)
{
    precise vec3 result = a - b;
    return result;
}

Evaluated evaluate_triangle(vec3 at)
{
    CornerTerms terms[3];
    [[unroll]] for (int i = 0; i < 3; ++i) {
        const int next = (i + 1) % 3;
        terms[i] = corner_terms(at[i], at[next], at[(i + 2) % 3], control_point[5 * i], control_point[5 * i + 1],
                                control_point[5 * next + 2], control_point[5 * i + 3], control_point[5 * i + 4]);
    }
    vec3 by_0 = sum_of(terms[0].by_own, terms[2].by_next, terms[1].by_previous);
    vec3 by_1 = sum_of(terms[1].by_own, terms[0].by_next, terms[2].by_previous);
    vec3 by_2 = sum_of(terms[2].by_own, terms[1].by_next, terms[0].by_previous);
    Evaluated result;
    result.position = sum_of(terms[0].position, terms[1].position, terms[2].position);
    result.along_u = difference(by_0, by_2);
    result.along_v = difference(by_1, by_2);
    return result;
}

// The tangents of a triangle along u and v of one of its thirds.
void tangents_of_part(uint part, Parameter u, Parameter v, inout vec3 along_u, inout vec3 along_v)
{
    // How the coordinates of the part's own corner and of the next one change; the three sum to 1.
    vec2 own = vec2(-0.5 * v.s - v.t / 6.0, -0.5 * u.s - u.t / 6.0);
    vec2 next = vec2(0.5 * v.s + v.t / 3.0, -u.t / 6.0);
    vec2 previous = -own - next;
    vec2 first = part == 0u ? own : (part == 1u ? previous : next);
    vec2 second = part == 1u ? own : (part == 2u ? previous : next);
    vec3 a = along_u;
    vec3 b = along_v;
    along_u = first.x * a + second.x * b;
    along_v = first.y * a + second.y * b;
}
#endif
