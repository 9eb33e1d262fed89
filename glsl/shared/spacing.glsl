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

// The factor that the spacing makes of a tess factor of at least 1: whole, as it is, or above 1 at least 2. An edge of factor 1
// has one segment with even spacing too: an irregular leaf, whose edges are such, has no point in the middle of one.
float spaced_factor(float factor)
{
    if (SPACING == SPACING_EQUAL) {
        return ceil(factor);
    }
    return SPACING == SPACING_FRACTIONAL_EVEN && factor > 1.0 ? max(factor, 2.0) : factor;
}

// Number of segments that a spaced factor makes: the next whole, odd or even number.
float segment_count(float factor)
{
    if (SPACING == SPACING_EQUAL) {
        return factor;
    }
    if (SPACING == SPACING_FRACTIONAL_EVEN && factor > 1.0) {
        return 2.0 * ceil(factor * 0.5);
    }
    return 2.0 * ceil((factor - 1.0) * 0.5) + 1.0;
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

// Point i of an edge with factor `low`; of one that is split, `low` and `high` are the factors of its halves, else `high` is 0.
Parameter edge_point(float i, float low, float high)
{
    float low_count = segment_count(low);
    Parameter result;
    if (high == 0.0) {
        result.t = place(i, low_count, low);
        result.s = place(low_count - i, low_count, low);
        return result;
    }
    float high_count = segment_count(high);
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

// The point of an edge at tessellator coordinate x.
Parameter edge_parameter(float x, float low, float high)
{
    float count = segment_count(low) + (high == 0.0 ? 0.0 : segment_count(high));
    return edge_point(round(x * count), low, high);
}

// Point i of n segments of one length.
Parameter even_point(float i, float n)
{
    precise float t = i / n;
    precise float s = (n - i) / n;
    return Parameter(t, s);
}

// The point of a row inside, with a spaced factor, or -n for n segments of one length.
Parameter row_parameter(float x, float factor)
{
    if (factor < 0.0) {
        return even_point(round(x * -factor), -factor);
    }
    return edge_parameter(x, factor, 0.0);
}
#endif
