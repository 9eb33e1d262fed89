// Tables of a mesh, as the subdiv crate builds them. Scalar layout, read through addresses.
#ifndef PLANISH_TABLES
#define PLANISH_TABLES
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

// Levels that a patch can have.
const uint LEVEL_COUNT = 16;

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
struct RegularPatch {
    uint points[16];
    PatchInfo info;
    float sharpness;
};

// Limit points at (0,0), (1,0), (1,1), (0,1).
struct FillingQuad {
    uint corners[4];
    PatchInfo info;
};

// The same with those at the middles of its edges and at its centre.
struct FillingQuadMidpoints {
    uint corners[4];
    uint midpoints[5];
    PatchInfo info;
};

struct LimitPoint {
    vec3 position;
    vec3 normal;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Points { vec3 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LimitPoints { LimitPoint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer StencilRows { StencilRow v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Indices { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EditTargets { EditTarget v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Weights { float v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LimitWeights { vec3 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RegularPatches { RegularPatch v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FillingQuads { FillingQuad v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FillingQuadsMidpoints { FillingQuadMidpoints v[]; };

uint patch_depth(PatchInfo info) { return bitfieldExtract(info.flags, 0, 5); }
uint patch_level(PatchInfo info) { return bitfieldExtract(info.flags, 5, 5); }
uint patch_boundary(PatchInfo info) { return bitfieldExtract(info.flags, 10, 4); }
uint patch_transition(PatchInfo info) { return bitfieldExtract(info.flags, 14, 4); }
uint patch_leaf(PatchInfo info) { return bitfieldExtract(info.flags, 18, 4); }
uint patch_crease(PatchInfo info) { return bitfieldExtract(info.flags, 22, 4); }

// (u, v) of a patch's own domain in the domain of its Ptex face.
vec2 ptex_uv(PatchInfo info, vec2 uv)
{
    vec2 corner = vec2(info.corner & 0xffffu, info.corner >> 16);
    return (corner + uv) * exp2(-float(patch_depth(info)));
}
#endif
