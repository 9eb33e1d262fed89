#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS
// Shades the surface: a key, a fill and a rim light over a small analytic sky; or a debug view; and the layers.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/shading.glsl"

layout(constant_id = 0) const uint VIEW = VIEW_SHADED;
layout(location = 0) in vec3 in_normal;
layout(location = 0) out vec4 out_color;
#if defined(LAYERS)
layout(location = 1) in vec3 in_position;
layout(location = 2) in vec2 in_uv;
layout(location = 3) in flat uvec4 in_ids;
layout(location = 4) in flat float in_factor;
layout(location = 1) out vec4 out_normal_depth;    // N, Z
layout(location = 2) out vec4 out_position_factor; // P, tess factor
layout(location = 3) out uvec4 out_ids;            // face, patch | level << 28, u, v as bits
#endif
#if defined(COLORS)
layout(location = 5) in vec3 in_color;
layout(location = 4) out vec4 out_surface_color;
#endif

void main()
{
    vec3 direction = view_ray(gl_FragCoord.xy);
    vec3 to_eye = direction * -inversesqrt(dot(direction, direction));
    // A point without a tangent plane has the normal 0; the bound keeps its pixels finite.
    vec3 normal = in_normal * inversesqrt(max(dot(in_normal, in_normal), 1e-20));
    // Mirrored objects have normals of MIRRORED_LENGTH, and triangles that run the other way round.
    bool is_mirrored = dot(in_normal, in_normal) > 1e6;
    vec3 facing = gl_FrontFacing != is_mirrored ? normal : -normal;
#if defined(LAYERS)
    out_color = vec4(view_color(VIEW, facing, to_eye, in_uv, in_ids, in_factor), 1.0);
    float depth = -(push.frame.v.world_to_camera * vec4(in_position, 1.0)).z;
    out_normal_depth = vec4(normal, depth);
    out_position_factor = vec4(in_position, in_factor);
    out_ids = uvec4(in_ids.x, in_ids.y | in_ids.z << 28, floatBitsToUint(clamp(in_uv, 0.0, 1.0)));
#else
    out_color = vec4(shade(facing, to_eye), 1.0);
#endif
#if defined(COLORS)
    out_surface_color = vec4(in_color, 1.0);
    out_color = VIEW == VIEW_COLOR ? out_surface_color : out_color;
#endif
}
