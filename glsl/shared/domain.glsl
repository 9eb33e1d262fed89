// Where a tessellated point of a patch lies, by the factors that its control shader set. Included where they are declared as inputs.
#ifndef PLANISH_DOMAIN
#define PLANISH_DOMAIN
#include "spacing.glsl"

// The point at x of an edge of the patch, or of the piece's part of it.
Parameter on_edge(uint edge, float x)
{
    float low = low_factors[edge];
    float high = TRANSITION ? high_factors[edge] : 0.0;
    if (!CUT) {
        return edge_parameter(x, low, high);
    }
    float first = float(piece_first[edge]);
    float last = float(piece_last[edge]);
    float i = min(first + round(x * max(last - first, 1.0)), last);
    return edge_point(i, low, high);
}

// The point at x of a row inside, along an axis.
Parameter in_row(uint axis, float x)
{
    if (!CUT) {
        return row_parameter(x, inner_factors[axis]);
    }
    float count = -inner_factors[axis];
    return even_point(float(piece_place[axis]) * count + round(x * count), float(piece_place.z) * count);
}

// The point's parameters, and the edges of the patch that it lies on.
void domain_point(out Parameter u, out Parameter v, out bvec4 is_on)
{
    vec2 x = gl_TessCoord.xy;
    // A point inside lies on the inner grid; one on an edge of the patch has that edge's own points.
    is_on = bvec4(x.y == 0.0, x.x == 1.0, x.y == 1.0, x.x == 0.0);
    if (CUT) {
        uint last = piece_place.z - 1u;
        is_on = bvec4(is_on.x && piece_place.y == 0u, is_on.y && piece_place.x == last, is_on.z && piece_place.y == last,
                      is_on.w && piece_place.x == 0u);
    }
    if (is_on.x) {
        u = on_edge(0, x.x);
    } else if (is_on.z) {
        u = on_edge(2, x.x);
    } else {
        u = in_row(0, x.x);
    }
    if (is_on.w) {
        u = Parameter(0.0, 1.0);
        v = on_edge(3, x.y);
    } else if (is_on.y) {
        u = Parameter(1.0, 0.0);
        v = on_edge(1, x.y);
    } else {
        v = in_row(1, x.y);
    }
    if (is_on.x) {
        v = Parameter(0.0, 1.0);
    } else if (is_on.z) {
        v = Parameter(1.0, 0.0);
    }
    // Where a segment has no length, or a piece has one point alone of an edge, that point may be a corner: so are all at its place.
    bvec2 is_along = bvec2(is_on.x || is_on.z, is_on.y || is_on.w);
    is_on = bvec4(is_on.x || (is_along.y && v.t == 0.0), is_on.y || (is_along.x && u.s == 0.0),
                  is_on.z || (is_along.y && v.s == 0.0), is_on.w || (is_along.x && u.t == 0.0));
}

// The tess factor that the tess view shows; -2 stands for a factor of 1 beside edges with more segments.
float shown_factor()
{
    float largest = max(inner_factors.x, inner_factors.y);
    return CUT ? -largest * float(piece_place.z) : max(largest, 1.0);
}
#endif
