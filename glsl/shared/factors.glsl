// Tess factors of a regular patch: a function of the densities at its corners, edge by edge, so that both sides of an edge
// agree. CPU twin: crates/render/src/factors.rs.
#ifndef PLANISH_FACTORS
#define PLANISH_FACTORS
#include "density.glsl"
#include "spacing.glsl"

// The most segments that the tessellator makes of an edge.
const float MAX_SEGMENTS = 64.0;

struct PatchFactors {
    vec4 low;          // spaced factor of each edge, or of its half with the lower u or v
    vec4 high;         // of the other half where the edge is split, else 0
    vec4 counts;       // segments of each edge
    vec2 inner;        // spaced factors of the rows inside, along u and v; -n for n segments of one length
    vec2 inner_counts;
};

// Factor of an edge of a level between vertices of two densities.
float edge_factor(float a, float b, float scale)
{
    precise float factor = (0.5 * (a + b)) * scale;
    return spaced_factor(max(factor, 1.0));
}

PatchFactors patch_factors(FaceDensity face, PatchInfo info, uint split_edges)
{
    vec4 d = corner_densities(face, info);
    float scale = halvings(patch_level(info));
    PatchFactors result;
    vec4 whole;
    [[dont_unroll]] for (uint edge = 0; edge < 4; ++edge) {
        // The half with the lower u or v begins at corner 0, 1, 3 or 0.
        uint low_corner = edge == 2u ? 3u : (edge == 1u ? 1u : 0u);
        uint high_corner = edge == 0u ? 1u : (edge == 3u ? 3u : 2u);
        bool is_leaf = (patch_leaf(info) >> edge & 1u) != 0u;
        whole[edge] = is_leaf ? spaced_factor(1.0) : edge_factor(d[low_corner], d[high_corner], scale);
        result.low[edge] = whole[edge];
        result.high[edge] = 0.0;
        result.counts[edge] = segment_count(whole[edge]);
        if ((split_edges >> edge & 1u) != 0u) {
            vec2 middle_uv = 0.5 * (square_corner(low_corner) + square_corner(high_corner));
            float middle = density_at(face, ptex_uv(info, middle_uv));
            result.low[edge] = edge_factor(d[low_corner], middle, 0.5 * scale);
            result.high[edge] = edge_factor(middle, d[high_corner], 0.5 * scale);
            result.counts[edge] = segment_count(result.low[edge]) + segment_count(result.high[edge]);
        }
    }
    result.inner = vec2(max(whole.x, whole.z), max(whole.y, whole.w));
    result.inner_counts = vec2(segment_count(result.inner.x), segment_count(result.inner.y));
    // The tessellator takes an inner level of 1 beside more segments for 2: say so ourselves.
    if (any(greaterThan(result.counts, vec4(1.0))) || any(greaterThan(result.inner_counts, vec2(1.0)))) {
        for (int i = 0; i < 2; ++i) {
            if (result.inner_counts[i] == 1.0) {
                result.inner[i] = -2.0;
                result.inner_counts[i] = 2.0;
            }
        }
    }
    return result;
}

// Of an entry of a draw list.
PatchFactors entry_factors(DrawEntry entry)
{
    PatchFactors result;
    result.low = entry.low;
    result.high = entry.high;
    result.inner = entry.inner;
    for (int edge = 0; edge < 4; ++edge) {
        float high_count = entry.high[edge] == 0.0 ? 0.0 : segment_count(entry.high[edge]);
        result.counts[edge] = segment_count(entry.low[edge]) + high_count;
    }
    for (int i = 0; i < 2; ++i) {
        result.inner_counts[i] = entry.inner[i] < 0.0 ? -entry.inner[i] : segment_count(entry.inner[i]);
    }
    return result;
}

// In how many pieces a side a patch must be cut.
uint cut_count(PatchFactors factors)
{
    float most = max(max(max(factors.counts.x, factors.counts.y), max(factors.counts.z, factors.counts.w)),
                     max(factors.inner_counts.x, factors.inner_counts.y));
    return uint(ceil(most * (1.0 / MAX_SEGMENTS)));
}

// A piece of a cut patch. Inside there are as many segments in every piece; the edges of the patch have their own points, of which
// a piece may have one alone: its edge has no length then.
struct PieceFactors {
    uvec2 inner;   // segments of the piece, along u and v
    uvec4 first;   // number of the first point of the piece's part of each of the patch's edges, from low u or v on
    uvec4 last;    // and of the last
    uvec4 counts;  // segments of the piece's own edges, at least 1
};

PieceFactors piece_factors(PatchFactors factors, uint pieces, uvec2 piece)
{
    PieceFactors result;
    uvec2 inner = uvec2(factors.inner_counts);
    result.inner = max((inner + (pieces - 1u)) / pieces, uvec2(2u));
    bvec4 is_on_edge = bvec4(piece.y == 0u, piece.x == pieces - 1u, piece.y == pieces - 1u, piece.x == 0u);
    for (int edge = 0; edge < 4; ++edge) {
        uint along = (edge & 1) == 0 ? piece.x : piece.y;
        uint count = uint(factors.counts[edge]);
        result.first[edge] = along * count / pieces;
        result.last[edge] = (along + 1u) * count / pieces;
        uint own = max(result.last[edge] - result.first[edge], 1u);
        result.counts[edge] = is_on_edge[edge] ? own : ((edge & 1) == 0 ? result.inner.x : result.inner.y);
    }
    return result;
}

// The parameters that a piece's points lie between.
void piece_bounds(PatchFactors factors, PieceFactors own, uint pieces, uvec2 piece, out vec2 low, out vec2 high)
{
    low = vec2(piece) / float(pieces);
    high = vec2(piece + 1u) / float(pieces);
    bvec4 is_on_edge = bvec4(piece.y == 0u, piece.x == pieces - 1u, piece.y == pieces - 1u, piece.x == 0u);
    for (int edge = 0; edge < 4; ++edge) {
        if (is_on_edge[edge]) {
            int axis = edge & 1;
            low[axis] = min(low[axis], edge_point(float(own.first[edge]), factors.low[edge], factors.high[edge]).t);
            high[axis] = max(high[axis], edge_point(float(own.last[edge]), factors.low[edge], factors.high[edge]).t);
        }
    }
}

// Triangles that the tessellator makes: the inner grid, and a ring between it and each edge.
uint triangle_count(uvec4 edges, uvec2 inner)
{
    if (edges == uvec4(1u) && inner == uvec2(1u)) {
        return 2u;
    }
    uvec2 rest = max(inner, uvec2(2u)) - 2u;
    return 2u * rest.x * rest.y + (edges.x + rest.x) + (edges.z + rest.x) + (edges.y + rest.y) + (edges.w + rest.y);
}

// Longest and shortest of the segments that a spaced factor makes.
vec2 segment_bounds(float factor)
{
    if (factor < 0.0) {
        return vec2(-1.0 / factor);
    }
    float n = segment_count(factor);
    if (SPACING == SPACING_EQUAL || n == 1.0) {
        return vec2(1.0 / n);
    }
    precise float end = 0.5 * (1.0 - (n - 2.0) / factor);
    return vec2(max(1.0 / factor, end), end);
}

// A triangle between two rows of points along an edge reaches over at most this many of the longest segments, and the
// distances of its tip from both ends of its base have at most these products; crates/render/src/factors.rs.
const float RING_REACH = 2.0;
const float RING_PRODUCT = 1.5;
const float MAX_RING_PRODUCT = 0.5;

Grain grain_of(PatchFactors factors)
{
    vec2 along_u = segment_bounds(factors.inner.x);
    vec2 along_v = segment_bounds(factors.inner.y);
    float longest = max(along_u.x, along_v.x);
    float shortest = min(along_u.y, along_v.y);
    float depth = shortest;
    Grain result;
    result.is_uneven = factors.high != vec4(0.0) || factors.low != factors.inner.xyxy;
    if (!result.is_uneven) {
        precise float grain = 1.0 / shortest;
        result.grain = grain;
        result.reach = 0.0;
        result.skew = 0.0;
        return result;
    }
    for (int edge = 0; edge < 4; ++edge) {
        vec2 low = segment_bounds(factors.low[edge]);
        if (factors.high[edge] != 0.0) {
            vec2 high = segment_bounds(factors.high[edge]);
            low = 0.5 * vec2(max(low.x, high.x), min(low.y, high.y));
        }
        longest = max(longest, low.x);
        shortest = min(shortest, low.y);
    }
    precise float reach = max(min(RING_REACH * longest, 1.0), depth);
    precise float product = min((RING_PRODUCT * longest) * longest, MAX_RING_PRODUCT);
    precise float grain = reach / (shortest * depth);
    precise float skew = product / (2.0 * depth);
    result.grain = grain;
    result.reach = sqrt(product);
    result.skew = skew;
    return result;
}
#endif
