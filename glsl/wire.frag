#version 460
// The lines of the wire view.
layout(location = 0) out vec4 out_color;

void main()
{
    out_color = vec4(vec3(0.01), 1.0);
}
