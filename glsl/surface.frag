#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING cutout=SHADING,CUTOUT shadow_cutout=SHADING,CUTOUT,SHADOW
// Shades the surface: a key, a fill and a rim light over a small analytic sky; or a debug view; and the layers. SHADING leaves what
// shade.comp shades (gbuffer.glsl); with CUTOUT materials have holes; SHADOW leaves depth alone.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/shading.glsl"

#if defined(SHADING)
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shared/gbuffer.glsl"
#endif
#if defined(CUTOUT)
#include "shared/textures.glsl"
#endif

layout(constant_id = 0) const uint VIEW = VIEW_SHADED;
layout(location = 0) in vec3 in_normal;
#if !defined(SHADOW)
layout(location = 0) out vec4 out_color;
#endif
#if defined(SHADING)
layout(location = 1) in vec3 in_color;
layout(location = 2) in vec2 in_tex_coord;
layout(location = 3) in flat uint in_face;
layout(location = 4) in flat uint in_object;
#if !defined(SHADOW)
layout(location = 1) out vec4 out_frame_depth;
layout(location = 2) out uvec4 out_ids;
layout(location = 3) out vec4 out_footprint;
#endif
#endif
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
layout(location = 6) in vec3 in_next_position;
layout(location = 7) in vec2 in_st;
layout(location = 4) out vec4 out_surface_color;
layout(location = 5) out vec4 out_motion_st; // where the point goes, in pixels to the right and down; texture coordinates

// Where a point of the world is seen at the next moment, in pixels from the upper left corner.
vec2 next_pixel(vec3 p)
{
    vec4 clip = push.frame.v.next_view_projection * vec4(p, 1.0);
    vec2 size = vec2(push.image_size & 0xffffu, push.image_size >> 16);
    return (0.5 + 0.5 * vec2(clip.x, -clip.y) / clip.w) * size;
}
#endif

#if defined(SHADING) && !defined(SHADOW)
// The direction along which s grows, as an angle around the normal, and whether t grows to its right: by differences to the next pixels,
// within one triangle. That of the surface's own parameters would need two vectors more of every method's evaluation.
float tangent_turn(vec3 normal, vec3 at_x, vec3 at_y, vec4 footprint, out bool is_turned)
{
    float area = footprint.x * footprint.w - footprint.y * footprint.z;
    float side = area < 0.0 ? -1.0 : 1.0;
    vec3 along_s = side * (at_x * footprint.w - at_y * footprint.y);
    vec3 along_t = side * (at_y * footprint.x - at_x * footprint.z);
    is_turned = dot(cross(normal, along_s), along_t) < 0.0;
    vec3 x;
    vec3 y;
    across(normal, x, y);
    return to_turn(vec2(dot(along_s, x), dot(along_s, y)));
}
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
#if defined(SHADING)
    vec4 footprint = vec4(0.0);
    float depth = 1.0 / gl_FragCoord.w;
    if (TEX_COORDS) {
        footprint = vec4(dFdx(in_tex_coord), dFdy(in_tex_coord));
    }
    bool is_back = gl_FrontFacing == is_mirrored;
#if defined(CUTOUT)
    MaterialScene scene = MaterialScene(push.frame.v.scene.v.materials);
    uint material = material_at(scene, in_object, in_face);
    if (passes(scene, material, in_object, is_back, uvec2(gl_FragCoord.xy), in_tex_coord, footprint)) {
        discard;
    }
#endif
#if !defined(SHADOW)
    bool is_turned = false;
    float turn = 0.0;
    if (TEX_COORDS) {
        vec3 point = direction * depth;
        turn = tangent_turn(facing, dFdx(point), dFdy(point), footprint, is_turned);
    }
    out_color = vec4(in_color, 1.0);
    out_frame_depth = vec4(to_octahedral(dot(normal, normal) > 0.5 ? facing : to_eye), turn, depth);
    out_ids = uvec4(in_object | (is_back ? GBUFFER_BACK : 0u) | (is_turned ? GBUFFER_TURNED : 0u), in_face,
                    floatBitsToUint(in_tex_coord));
    out_footprint = footprint;
#endif
#elif defined(LAYERS)
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
    out_motion_st = vec4(next_pixel(in_next_position) - gl_FragCoord.xy, in_st);
    out_color = VIEW == VIEW_COLOR ? out_surface_color : out_color;
#endif
}
