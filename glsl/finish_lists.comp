#version 460
// Closes the draw lists: what did not fit is not drawn. The counts tell how many there should have been.
#extension GL_GOOGLE_include_directive : require
#include "shared/scene.glsl"
layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    DrawHeads heads;
} push;

void main()
{
    uint draw = gl_LocalInvocationID.x;
    if (draw < DRAW_COUNT) {
        push.heads.v[draw].all = DrawArguments(min(push.heads.v[draw].count, push.heads.v[draw].capacity), 1u, 0u, 0u);
    }
}
