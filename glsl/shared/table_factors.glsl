// Factors of patches that are evaluated by table, and the points that these ask for. CPU twin: crates/render/src/table.rs.
//
// The points of an edge, and those inside, are every 2^k-th of the table's. A factor between powers of two has the points of the next
// one, of which every second moves from the middle of its neighbours to its own place (the geomorph of section II.C).
#ifndef PLANISH_TABLE_FACTORS
#define PLANISH_TABLE_FACTORS
#include "density.glsl"

bool is_table_triangle(uint flags) { return (flags & TABLE_TRIANGLE) != 0u; }

// Parameters of a corner on its Ptex face.
vec2 table_corner_uv(uint corner_uvs, uint corner, uint steps)
{
    uint first = 6u * corner;
    return halvings(steps) * vec2(bitfieldExtract(corner_uvs, int(first), 3), bitfieldExtract(corner_uvs, int(first + 3u), 3));
}

// Density at a corner. A triangle's are linear between those of the cage's vertices; at its corners and at the middles of its edges
// both sides of an edge have the same bits.
float table_density(FaceDensity face, bool is_triangle, vec2 uv)
{
    precise float first = (1.0 - uv.x) - uv.y;
    precise float in_triangle = (first * face.at.x + uv.x * face.at.y) + uv.y * face.at.z;
    return is_triangle ? in_triangle : density_at(face, uv);
}

// Factor of each edge, from 1 to the segments of the table.
vec4 table_factors(FaceDensity face, uint flags, uint corner_uvs, uint steps, uint level)
{
    bool is_triangle = is_table_triangle(flags);
    float most = float(1u << level);
    uint sides = is_triangle ? 3u : 4u;
    vec4 d;
    [[dont_unroll]] for (uint corner = 0u; corner < 4u; ++corner) {
        d[corner] = table_density(face, is_triangle, table_corner_uv(corner_uvs, min(corner, sides - 1u), steps));
    }
    vec4 result = vec4(1.0);
    [[dont_unroll]] for (uint edge = 0u; edge < sides; ++edge) {
        // What an edge of the cage is asked to have is had by all that it was split into.
        precise float factor = (0.5 * (d[edge] + d[edge + 1u == sides ? 0u : edge + 1u])) * halvings(steps);
        result[edge] = clamp(factor, 1.0, most);
    }
    return result;
}

// The next power of two.
uint table_segments(float factor)
{
    uint whole = uint(ceil(factor));
    return whole <= 1u ? 1u : 2u << findMSB(whole - 1u);
}

// How far points that the next smaller power of two does not have are on their way: above 0, up to 1.
precise float table_morph(float factor, uint segments)
{
    precise float result = segments == 1u ? 1.0 : factor * (2.0 / float(segments)) - 1.0;
    return result;
}

float largest_factor(vec4 factors)
{
    return max(max(factors.x, factors.y), max(factors.z, factors.w));
}
#endif
