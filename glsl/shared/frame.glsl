// What a frame's draws share.
#ifndef PLANISH_FRAME
#define PLANISH_FRAME
#include "tables.glsl"

// Levels that a patch can have, and one more for the finer side of an edge.
const uint FACTOR_COUNT = 17;

struct FrameData {
    mat4 view_projection; // world to clip space
    mat4 world_to_camera; // right-handed, looking down -z
    vec3 ray_corner;      // world-space direction through the image's upper left corner
    vec3 ray_dx;          // its change from one pixel to the next
    vec3 ray_dy;          // and from one line to the next
    float factors[FACTOR_COUNT]; // tess factor of each level: max(1, t / 2^k)
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Frame { FrameData v; };

layout(push_constant, scalar) uniform DrawPush {
    Frame frame;
    Indices list; // patches to draw, as indices into the table
    Points points;
    RegularPatches patches;
    FillingQuads quads;
    Indices midpoints; // five limit points a filling quad
    LimitPoints limits;
    uint first_patch_id; // number of the table's first patch among all patches of the mesh
} push;
#endif
