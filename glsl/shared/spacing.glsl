// Where tessellated points lie along an edge, for all spacings.
//
// The tessellator always runs with equal spacing and whole factors: it decides how many points there are, and this file
// decides where. Fractional points are then the same on every device (Vulkan leaves their places to the driver), both
// sides of an edge compute them from the same integers, and an edge whose neighbour was split is one edge with the
// points of both halves. So a transition patch stays a single quad, instead of the up to five sub-patches of FAS figure 7.
#ifndef PLANISH_SPACING
#define PLANISH_SPACING
const uint SPACING_EQUAL = 0;
const uint SPACING_FRACTIONAL_ODD = 1;
const uint SPACING_FRACTIONAL_EVEN = 2;
layout(constant_id = 0) const uint SPACING = SPACING_FRACTIONAL_ODD;

// The factor that the spacing makes of a tess factor: whole, at least 1, or at least 2.
float spaced_factor(float factor)
{
    if (SPACING == SPACING_EQUAL) {
        return ceil(factor);
    }
    return max(factor, SPACING == SPACING_FRACTIONAL_EVEN ? 2.0 : 1.0);
}

// Number of segments that a spaced factor makes: the next whole, odd or even number.
float segment_count(float factor)
{
    if (SPACING == SPACING_EQUAL) {
        return factor;
    }
    return SPACING == SPACING_FRACTIONAL_ODD ? 2.0 * ceil((factor - 1.0) * 0.5) + 1.0 : 2.0 * ceil(factor * 0.5);
}

// Place of point i of n on an edge of the given spaced factor f: n - 2 segments of length 1 / f and at the ends two that
// share the rest. place(i) and place(n - i) are mirror images, each computed from its own integer.
precise float place(float i, float n, float factor)
{
    if (SPACING == SPACING_EQUAL) {
        return i / n;
    }
    precise float inner = (i - 0.5 * (n - factor)) / factor;
    return i <= 0.0 ? 0.0 : (i >= n ? 1.0 : inner);
}

// A parameter t together with 1 - t, both exact to rounding.
struct Parameter {
    float t;
    float s;
};

// The point at tessellator coordinate x of an edge with factor `low`; where the neighbour was split, `low` and `high`
// are the factors of its halves, else `high` is 0.
Parameter edge_parameter(float x, float low, float high)
{
    float low_count = segment_count(low);
    Parameter result;
    if (high == 0.0) {
        float i = round(x * low_count);
        result.t = place(i, low_count, low);
        result.s = place(low_count - i, low_count, low);
        return result;
    }
    float high_count = segment_count(high);
    float i = round(x * (low_count + high_count));
    if (i <= low_count) {
        precise float t = 0.5 * place(i, low_count, low);
        precise float s = 0.5 + 0.5 * place(low_count - i, low_count, low);
        result.t = t;
        result.s = s;
    } else {
        i -= low_count;
        precise float t = 0.5 + 0.5 * place(i, high_count, high);
        precise float s = 0.5 * place(high_count - i, high_count, high);
        result.t = t;
        result.s = s;
    }
    return result;
}
#endif
