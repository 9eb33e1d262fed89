#version 460
// Passes on which patch of a table is drawn. The place in the list is the vertex plus the instance: hardware draws
// { N vertices, 1 instance }, a software driver { 1 vertex, N instances }, since its cost for one instance is quadratic.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"

layout(location = 0) out uint patch_index;

void main()
{
    patch_index = push.list.v[gl_VertexIndex + gl_InstanceIndex];
}
