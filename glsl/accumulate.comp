#version 460
// Adds a sample of every pixel, four halves, to the frame's sum: one thread, one pixel.
#extension GL_GOOGLE_include_directive : require
#include "shared/pixels.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

layout(push_constant, scalar) uniform AccumulatePush {
    HalfVec4s colors;
    Vec4s sum;
    uint count; // pixels
} push;

void main()
{
    uint pixel = thread_index();
    if (pixel >= push.count) {
        return;
    }
    uvec2 color = push.colors.v[pixel];
    push.sum.v[pixel] += vec4(unpackHalf2x16(color.x), unpackHalf2x16(color.y));
}
