// The G-buffer: what the SHADING variant of surface.frag leaves of a pixel, and shade.comp reads.
//
// | target | holds |
// |---|---|
// | 0, halves | colour of vertices; 1 |
// | 1, floats | shading normal that faces the eye, octahedral; tangent, as an angle; depth, 0 where nothing is |
// | 2, words | object with flags; Ptex face among those of all objects; texture coordinates as bits |
// | 3, halves | change of the texture coordinates to the next pixel, and to the next line |
#ifndef PLANISH_GBUFFER
#define PLANISH_GBUFFER

const uint GBUFFER_BACK = 0x80000000u;   // the surface shows its back
const uint GBUFFER_TURNED = 0x40000000u; // texture coordinates run clockwise, seen from the side that the normal is on
const uint GBUFFER_OBJECT = 0x3fffffffu;

// A unit vector in a square (Cigolle et al. 2014, A Survey of Efficient Representations for Independent Unit Vectors).
vec2 to_octahedral(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 signs = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * signs;
}

vec3 from_octahedral(vec2 p)
{
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec2 signs = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    vec2 xy = z >= 0.0 ? p : (1.0 - abs(p.yx)) * signs;
    return normalize(vec3(xy, z));
}

// Two unit vectors across a unit vector (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
void across(vec3 n, out vec3 x, out vec3 y)
{
    float side = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + n.z);
    float b = n.x * n.y * a;
    x = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
    y = vec3(b, side + n.y * n.y * a, -n.y);
}

// A direction in the plane, as a number of -2 to 2 that grows with its angle: without trigonometry.
float to_turn(vec2 v)
{
    float length = abs(v.x) + abs(v.y);
    float y = length > 0.0 ? v.y / length : 0.0;
    return v.x >= 0.0 ? y : (v.y >= 0.0 ? 2.0 - y : -2.0 - y);
}

vec2 from_turn(float turn)
{
    float y = abs(turn) <= 1.0 ? turn : (turn > 0.0 ? 2.0 - turn : -2.0 - turn);
    return normalize(vec2(abs(turn) <= 1.0 ? 1.0 - abs(y) : abs(y) - 1.0, y));
}
#endif
