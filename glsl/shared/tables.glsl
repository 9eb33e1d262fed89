// Tables of meshes, as the subdiv crate builds them. Scalar layout, read through addresses.
#ifndef PLANISH_TABLES
#define PLANISH_TABLES
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

// Levels that a patch can have.
const uint LEVEL_COUNT = 16;
// "There is none", for any index.
const uint NONE = 0xffffffffu;

// `count` indices from `first_index` on, weighted by as many weights from `first_weight` on.
struct StencilRow {
    uint first_index;
    uint first_weight;
    uint count;
};

// A point that hierarchical edits change: its position is kept and moved, or replaced.
struct EditTarget {
    uint point;
    uint keeps;
};

// Where a patch lies and what it borders; the bits are those of subdiv's PatchInfo.
struct PatchInfo {
    uint ptex_face;
    uint corner;
    uint flags;
};

// 16 control points, row by row; rows that the boundary mask names are reflections. Sharpness of the crease edge, or 0.
// Edges that may be split, because an irregular face lies across, have a number.
struct RegularPatch {
    uint points[16];
    PatchInfo info;
    float sharpness;
    uint edges[4];
    uint seams; // place of its PatchSeams; NONE if it takes nothing from other patches
};

// What a patch takes from others, so that they agree to the bit: the limit points that its corners are, and the coarser
// patches that its edges are halves of edges of; NONE for none.
struct PatchSeams {
    uint limits[4];
    uint borders[4]; // bit 0: the edges run against each other, 1-2: which half, or 2 for all, 3-4: the edge, 5-31: the patch
};

// A child of an irregular face is one itself if this bit is set, else a regular patch.
const uint IRREGULAR_CHILD = 0x80000000u;
const uint FACE_FORCED = 1;
const uint FACE_HIDDEN = 2;
// Bits 2-5: the limit point of the corner is made of points one level down.
const uint FACE_STAR_LIMITS_SHIFT = 2;

// An irregular face of any level: refined in some frames, a filling quad in others.
struct IrregularFace {
    PatchInfo info;
    uint children[4];
    uint edges[4];     // numbers of its edges among those that can be split
    uint stars[4];     // of its corners: the points one level down around them
    uint limits[4];    // limit points at its corners
    uint midpoints[4]; // and at the middles of its edges
    uint flags;
};

// What an irregular face is drawn as where it is a Gregory patch.
const uint GREGORY_NONE = 0;
const uint GREGORY_QUAD = 1;
const uint GREGORY_NGON = 2;     // the quad at a corner of a face of more than four sides
const uint GREGORY_TRIANGLE = 3; // + part: the third of a triangle at that corner

// The side that decides where points of an edge are displaced to. Flags: bits 0-1 its edge, 2 the edges run against each other, 3 it
// is a face of other than four sides, whose parts at the edge's two ends are named, 4 nothing lies across.
struct EdgeOwner {
    uint faces[2]; // Ptex faces
    uint flags;
};

// An irregular face as a Gregory patch. Seats are corners; of a part of a face of more than four sides the corner before, the
// corner, the corner after and the centre. Edge i runs from seat i to the next; of such a part: from the corner before, to the corner
// after, from the centre to the middle of the edge before, and to that of the edge after.
struct GregoryFace {
    uint limits[4];
    uint first[4];    // the spoke of each edge at its first end
    uint last[4];     // and at its other end
    float cosines[4]; // of the angle between neighbouring tangents at each seat
    uint borders[4];  // the bicubic patch across each edge, as PatchSeams has them
    uint flags;       // bits 0-2 the kind, bits 4-7 edges without a smooth surface across
    EdgeOwner owners[4];
    uint part_before; // Ptex face of the part before, of a face of other than four sides
};

// How the control points of a Gregory patch are made of the cage's points: of a matrix that has a row for each of e+, e-, f+, f- of
// each corner, then one for each of the four vectors across each edge, and lies column by column; and of a ring that names points
// in ascending order, and their columns.
struct GregoryStencil {
    uint corners[4];   // points that the sums of rows are relative to
    uint first_point;  // of the ring
    uint point_count;  // 0: the patch's points are made of spokes
    uint first_weight;
    uint spoke_edges;  // edges whose points are those of the spokes, one bit each
};

uint gregory_kind(uint flags) { return min(flags & 7u, GREGORY_TRIANGLE); }

// A limit point's weights for what it gives to the patches along an edge.
struct Spoke {
    vec2 along;      // of its tangents in the edge point
    float direct;    // of the vector to the edge's other end
    uint end;        // the point there
    uint is_projected; // 1: of that vector only what lies in the tangent plane
    uint before;     // spokes around the limit point, or NONE
    uint after;
    StencilRow row;  // of the vector beside
};

// What a limit point gives to the patches along an edge by ACC or for Pm-patches: rows whose first index is the point that the others
// are taken from.
struct RivalSpoke {
    StencilRow edge;   // from the limit point to the end of a third of the tangent along the edge
    StencilRow across; // derivative across it
    StencilRow beside; // 3/2 of what lies between the inner points of both faces
    StencilRow middle; // to the middle of these
};

// What a limit point gives: the edge point, and two vectors to the left of the edge.
struct SpokePoint {
    vec3 edge;
    vec3 across;
    vec3 beside;
};

// Limit points at (0,0), (1,0), (1,1), (0,1).
struct FillingQuad {
    uint corners[4];
    PatchInfo info;
};

// A face of the cage after one or two steps of subdivision, whose points are rows of a table (Hollaender and Boubekeur 2010): of a
// grid of points, `control_count` weights each, of these controls. Tangents lie as the weights do. Or a face of the cage itself, of a
// substitute, whose controls are its corners.
struct TablePatch {
    uint corners[4];    // limit points; of a triangle the last is the first
    uint edges[4];      // edge << 1 | it runs the other way; the first from corner 0 to 1
    uint first_control;
    uint control_count;
    uint first_weight;
    uint ptex_face;
    uint corner_uvs;    // parameters of the corners on the Ptex face, in 2^-steps: 3 bits for u and 3 for v each
    uint flags;         // bits 0-3 edges, 4-7 corners, whose normal is the patch's own; TABLE_TRIANGLE
};
const uint TABLE_TRIANGLE = 256;

// An edge between such faces: a row of points from one end to the other that both have.
struct TableEdge {
    uint first_control;
    uint control_count;
    uint first_weight;
};

struct LimitPoint {
    vec3 position;
    vec3 normal;
};

struct LimitTangents {
    vec3 a;
    vec3 b;
};

// What the displacement at a limit point is found by, whoever draws it: all sectors of a vertex have the same.
struct LimitSeat {
    uint canonical; // the limit point whose normal is the direction
    vec2 uv;        // texture coordinates
    vec2 along_a;   // of the point's own sector: their change along its tangents
    vec2 along_b;
};

// How the texels of a displacement map lie.
const uint LAYOUT_REPEAT = 0; // one tile over texture coordinates that repeats
const uint LAYOUT_UDIM = 1;   // a tile for each unit square of them
const uint LAYOUT_FACES = 2;  // a tile for each Ptex face

struct MapLevel {
    uint first_texel;
    uint width;
    uint height;
};

struct MapTile {
    uint first_level;
    uint level_count;
};

// Slots of the densities at the corners of a Ptex face, from the object's first on. That of corner 2 has this bit in the parts
// of a face of other than four sides: it is the face's middle, corners 1 and 3 are its next and previous vertex.
const uint PART_OF_FACE = 0x80000000u;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Points { vec3 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LimitPoints { LimitPoint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer StencilRows { StencilRow v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Indices { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EditTargets { EditTarget v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Weights { float v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LimitWeights { vec3 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RegularPatches { RegularPatch v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SeamTable { PatchSeams v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer IrregularFaces { IrregularFace v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GregoryFaces { GregoryFace v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GregoryStencils { GregoryStencil v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RingPoints { uvec3 v[]; }; // point, column, and a mask of the rows with a weight
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TablePatches { TablePatch v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TableEdges { TableEdge v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TableTangents { vec2 v[]; };
// Two numbers of 16 bits a word, from -1 to 1 in steps of 1/32767: of weights one after the other, of tangents those of one point.
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShortWeights { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Spokes { Spoke v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RivalSpokes { RivalSpoke v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SpokeRanges { uvec2 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SpokePoints { SpokePoint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FillingQuads { FillingQuad v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LimitTangentTable { LimitTangents v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LimitSeats { LimitSeat v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MapLevels { MapLevel v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MapTiles { MapTile v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TexCoords { vec2 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer PtexFaces { uvec4 v[]; };

// A displacement map; texels have one number, along the normal, or three, a vector in the mesh's own space.
struct DisplacementMap {
    Weights texels;
    MapLevels levels;
    MapTiles tiles;
    Indices tile_of; // unit square to tile; NONE for none
    Indices parts;   // one bit a Ptex face: it is a part of a face of other than four sides
    uint channels;
    uint layout_kind;
    uint tile_columns;
    uint tile_rows;
    uint level_count;
    vec2 texel;      // between neighbours of the finest level, in texture coordinates or parameters
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer DisplacementMaps { DisplacementMap v[]; };

uint patch_depth(PatchInfo info) { return bitfieldExtract(info.flags, 0, 5); }
uint patch_level(PatchInfo info) { return bitfieldExtract(info.flags, 5, 5); }
uint patch_boundary(PatchInfo info) { return bitfieldExtract(info.flags, 10, 4); }
uint patch_transition(PatchInfo info) { return bitfieldExtract(info.flags, 14, 4); }
uint patch_leaf(PatchInfo info) { return bitfieldExtract(info.flags, 18, 4); }
uint patch_crease(PatchInfo info) { return bitfieldExtract(info.flags, 22, 4); }

// 2^-k, exactly: exp2 need not be.
float halvings(uint k) { return uintBitsToFloat((127u - k) << 23); }

// (u, v) of a patch's own domain in the domain of its Ptex face.
vec2 ptex_uv(PatchInfo info, vec2 uv)
{
    vec2 corner = vec2(info.corner & 0xffffu, info.corner >> 16);
    return (corner + uv) * halvings(patch_depth(info));
}
#endif
