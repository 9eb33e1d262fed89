// What a frame's draws share.
#ifndef PLANISH_FRAME
#define PLANISH_FRAME
#include "scene.glsl"

struct FrameData {
    SceneTables scene;
    mat4 world_to_camera; // right-handed, looking down -z
    mat4 next_view_projection; // world to clip space at the next moment
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Frame { FrameData v; };

// Exactly the 128 bytes that every device has. What every vertex and every pixel reads is here and not behind an address:
// hardware keeps it in scalar registers, and a software driver would load it lane by lane.
layout(push_constant, scalar) uniform DrawPush {
    mat4 view_projection; // world to clip space
    DrawEntries list;     // patches to draw
    Points points;        // control points; limit points for filling quads
    RegularPatches patches; // table of patches; irregular faces, or quads, for filling quads
    Frame frame;
    vec3 ray_dx;          // change of the view ray, at depth 1, from one pixel to the next, in world space
    vec3 ray_dy;          // and from one line to the next
    uint image_size;      // width | height << 16, in pixels
    uint first_patch_id;  // number of the table's first patch among all patches of the mesh
} push;

// World-space direction from the eye through a point of the image, in pixels; not of unit length.
vec3 view_ray(vec2 pixel)
{
    vec2 middle = 0.5 * vec2(push.image_size & 0xffffu, push.image_size >> 16);
    vec3 across = cross(push.ray_dx, push.ray_dy);
    return across * inversesqrt(dot(across, across)) + (pixel.x - middle.x) * push.ray_dx + (pixel.y - middle.y) * push.ray_dy;
}
#endif
