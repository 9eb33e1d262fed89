// Sets the tessellation levels of a patch, and what its evaluation shader finds its points by (domain.glsl). Included where those are
// declared as outputs.
#ifndef PLANISH_LEVELS
#define PLANISH_LEVELS
#include "entry.glsl"
#include "factors.glsl"

void set_factors(PatchFactors factors, uint flags)
{
    low_factors = factors.low;
    high_factors = factors.high;
    uvec4 counts = uvec4(factors.counts);
    uvec2 inner = uvec2(factors.inner_counts);
    inner_factors = factors.inner;
    if (CUT) {
        uint pieces = entry_pieces(flags);
        uvec2 piece = entry_piece(flags);
        PieceFactors own = piece_factors(factors, pieces, piece);
        piece_place = uvec3(piece, pieces);
        piece_first = own.first;
        piece_last = own.last;
        counts = own.counts;
        inner = own.inner;
        inner_factors = -vec2(own.inner);
    }
    // Edge 0 is v = 0, 1 is u = 1, 2 is v = 1, 3 is u = 0; the tessellator numbers u = 0, v = 0, u = 1, v = 1.
    gl_TessLevelOuter[0] = float(counts.w);
    gl_TessLevelOuter[1] = float(counts.x);
    gl_TessLevelOuter[2] = float(counts.y);
    gl_TessLevelOuter[3] = float(counts.z);
    gl_TessLevelInner[0] = float(inner.x);
    gl_TessLevelInner[1] = float(inner.y);
}
#endif
