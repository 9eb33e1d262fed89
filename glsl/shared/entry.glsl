// Flags of an entry of a draw list: bits 0-3 the edges that are split; of a piece of a cut patch bits 4-11 and 12-19 its place
// along u and v, bits 20-28 how many pieces there are along a side.
#ifndef PLANISH_ENTRY
#define PLANISH_ENTRY
// The number of a patch with this bit set: its object is mirrored.
const uint PATCH_MIRRORED = 0x80000000u;

uint entry_split_edges(uint flags) { return flags & 15u; }
uvec2 entry_piece(uint flags) { return uvec2(bitfieldExtract(flags, 4, 8), bitfieldExtract(flags, 12, 8)); }
uint entry_pieces(uint flags) { return bitfieldExtract(flags, 20, 9); }
uint entry_flags(uint split_edges, uint pieces, uvec2 piece)
{
    return split_edges | piece.x << 4 | piece.y << 12 | pieces << 20;
}
#endif
