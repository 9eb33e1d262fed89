// What an evaluated point of the surface becomes: outputs for the beauty image, for all layers, or for a dump.
//
// LEAN draws the beauty image from the normal alone; every interpolated value costs triangle set-up. LAYERS carries what
// the other layers and the debug views need, with COLORS the colour too. SHADING carries what materials need (gbuffer.glsl). DUMP is
// captured by transform feedback.
#ifndef PLANISH_SURFACE
#define PLANISH_SURFACE
#include "frame.glsl"
#include "entry.glsl"

const uint KIND_REGULAR = 0;
const uint KIND_TRANSITION = 1;
const uint KIND_FILLING = 2;
const uint KIND_GREGORY_QUAD = 3;
const uint KIND_GREGORY_TRIANGLE = 4;
const uint KIND_TABLE = 5;
// Shown, not dumped.
const uint KIND_CREASE = 6;
const uint KIND_BOUNDARY = 7;

#if defined(DUMP)
layout(xfb_buffer = 0, xfb_stride = 72) out;
layout(location = 0, xfb_buffer = 0, xfb_offset = 0) out vec3 out_position;
layout(location = 1, xfb_buffer = 0, xfb_offset = 12) out vec3 out_normal;
layout(location = 2, xfb_buffer = 0, xfb_offset = 24) out vec2 out_uv;
layout(location = 3, xfb_buffer = 0, xfb_offset = 32) out uvec2 out_face; // Ptex face; level and kind << 8
layout(location = 4, xfb_buffer = 0, xfb_offset = 40) out vec2 out_tex_coord;
layout(location = 5, xfb_buffer = 0, xfb_offset = 48) out vec3 out_shading_normal;
layout(location = 6, xfb_buffer = 0, xfb_offset = 60) out vec3 out_color;
#else
layout(location = 0) out vec3 out_normal;
#if defined(SHADING)
layout(location = 1) out vec3 out_color;
layout(location = 2) out vec2 out_tex_coord;
layout(location = 3) out flat uint out_face; // Ptex face, among those of all objects
layout(location = 4) out flat uint out_object;
#endif
#if defined(LAYERS)
layout(location = 1) out vec3 out_position;
layout(location = 2) out vec2 out_uv;
layout(location = 3) out flat uvec4 out_ids; // Ptex face, patch, level, kind
layout(location = 4) out flat float out_factor;
#if defined(COLORS)
layout(location = 5) out vec3 out_color;
layout(location = 6) out vec3 out_next_position; // at the next moment, in the world
layout(location = 7) out vec2 out_st;
#endif
#endif
#endif

#if defined(LAYERS)
// The kind that the patch view shows: patches along creases and boundaries are told from other regular ones.
uint shown_kind(PatchInfo info, uint kind)
{
    if (kind != KIND_FILLING && patch_crease(info) != 0u) {
        return KIND_CREASE;
    }
    return kind == KIND_REGULAR && patch_boundary(info) != 0u ? KIND_BOUNDARY : kind;
}
#endif

// How long the normals of mirrored objects are: the shading of their triangles, which show their backs outside, knows them by
// it, as every value more that is interpolated costs triangle set-up.
const float MIRRORED_LENGTH = 1048576.0;

// Gives the point a colour; without it is white. After put_surface_point.
void put_color(vec3 color)
{
#if defined(DUMP) || defined(COLORS) || defined(SHADING)
    out_color = color;
#endif
}

// Says where the point is at the next moment, in the world.
void put_next_position(vec3 position)
{
#if defined(COLORS)
    out_next_position = position;
#endif
}

// Says which object the point is of.
void put_object(uint object)
{
#if defined(SHADING)
    out_object = object;
#endif
}

// `normal` is the limit surface's, along which it is displaced; `shading_normal` that of the surface drawn. `patch_id`: the patch's
// number, with PATCH_MIRRORED.
void put_surface_point(vec3 position, vec3 normal, vec3 shading_normal, vec2 uv, vec2 st, PatchInfo info, uint patch_id, uint kind, float factor)
{
    bool is_mirrored = (patch_id & PATCH_MIRRORED) != 0u;
    gl_Position = push.view_projection * vec4(position, 1.0);
    put_color(vec3(1.0));
    put_next_position(position);
#if defined(COLORS)
    out_st = st;
#endif
#if defined(DUMP)
    out_normal = is_mirrored ? -normal : normal;
    out_tex_coord = st;
    out_shading_normal = is_mirrored ? -shading_normal : shading_normal;
    out_position = position;
    out_uv = ptex_uv(info, uv);
    out_face = uvec2(info.ptex_face, patch_level(info) | kind << 8);
#else
    out_normal = is_mirrored ? -MIRRORED_LENGTH * shading_normal : shading_normal;
#if defined(SHADING)
    out_tex_coord = st;
    out_face = info.ptex_face;
#endif
#if defined(LAYERS)
    out_position = position;
    out_uv = ptex_uv(info, uv);
    out_ids = uvec4(info.ptex_face, patch_id & ~PATCH_MIRRORED, patch_level(info), shown_kind(info, kind));
    out_factor = factor;
#endif
#endif
}
#endif
