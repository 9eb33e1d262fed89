#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING dump=DUMP
// Patch-filling quads: every tessellated point is a limit point.
#extension GL_GOOGLE_include_directive : require
#include "shared/surface.glsl"
#include "shared/colors.glsl"
#include "shared/motion.glsl"

layout(quads, equal_spacing, ccw) in;
layout(location = 0) in vec3 limit_position[];
layout(location = 1) in vec3 limit_normal[];
layout(location = 2) patch in uvec4 patch_words;
layout(location = 3) patch in uvec2 fan_and_object;
layout(location = 4) in vec3 shading_normal[];
layout(location = 5) in vec2 tex_coord[];

// Which limit point lies at column i, row j of the 3 x 3. There is none in the middle: it becomes the fan's point, so that the
// triangles around it are those of a fan, and two without area.
const uint PLACES[9] = uint[9](0, 4, 1, 7, 0, 5, 3, 6, 2);
const vec2 UVS[8] = vec2[8](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0), vec2(0.5, 0.0), vec2(1.0, 0.5),
                            vec2(0.5, 1.0), vec2(0.0, 0.5));

// The limit point that one of the points is. Of edges that are not split no middle is looked at.
uint limit_of(uint place)
{
    IrregularFaces faces = IrregularFaces(push.patches);
    uint face = (patch_words.w & ~PATCH_MIRRORED) - push.first_patch_id;
    return place < 4u ? faces.v[face].limits[place] : faces.v[face].midpoints[place - 4u];
}

vec3 point_color(uint place, PatchInfo info)
{
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[fan_and_object.y];
    return limit_color(scene, object, limit_of(place), info.ptex_face - object.first_face, ptex_uv(info, UVS[place]));
}

void main()
{
    // Within the arrays for threads without a point too: a software driver reads for all.
    uvec2 grid = uvec2(clamp(round(2.0 * gl_TessCoord.xy), 0.0, 2.0));
    uint place = (grid == uvec2(1u) ? fan_and_object.x : PLACES[3 * grid.y + grid.x]) & 7u;
    vec3 shading = DISPLACED ? shading_normal[place] : limit_normal[place];
    vec2 st = TEX_COORDS ? tex_coord[place] : vec2(0.0);
    PatchInfo info = PatchInfo(patch_words.x, patch_words.y, patch_words.z);
    put_surface_point(limit_position[place], limit_normal[place], shading, UVS[place], st, info, patch_words.w, KIND_FILLING, 1.0);
    put_object(fan_and_object.y);
    if (COLORED) {
        put_color(point_color(place, info));
    }
    if (MOVING) {
        SceneTables scene = push.frame.v.scene;
        put_next_position(next_limit(scene, scene.v.objects.v[fan_and_object.y], limit_of(place), limit_position[place]));
    }
}
