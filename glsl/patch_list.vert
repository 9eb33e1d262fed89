#version 460
// Passes on which patch is drawn. The place in the list is the vertex plus the instance, so a list can be drawn in
// any shape: whole on hardware, in small batches on a software driver, whose cost for one instance is quadratic.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"

layout(location = 0) out uint list_place;

void main()
{
    list_place = gl_VertexIndex + gl_InstanceIndex;
}
