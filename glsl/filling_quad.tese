#version 460
// variants: lean=LEAN layers=LAYERS dump=DUMP
// Patch-filling quads: every tessellated point is a limit point.
#extension GL_GOOGLE_include_directive : require
#include "shared/surface.glsl"

layout(quads, equal_spacing, ccw) in;
layout(location = 0) in vec3 limit_position[];
layout(location = 1) in vec3 limit_normal[];
layout(location = 2) patch in uvec4 patch_words;

// Which limit point lies at column i, row j of the 3 x 3: corners 0 to 3, edges 4 to 7, centre 8.
const uint PLACES[9] = uint[9](0, 4, 1, 7, 8, 5, 3, 6, 2);

void main()
{
    vec2 uv = gl_TessCoord.xy;
    uvec2 grid = uvec2(round(2.0 * uv));
    uint place = PLACES[3 * grid.y + grid.x];
    put_surface_point(limit_position[place], limit_normal[place], 0.5 * vec2(grid),
                      PatchInfo(patch_words.x, patch_words.y, patch_words.z), patch_words.w, KIND_FILLING);
}
