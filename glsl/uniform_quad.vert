#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING dump=DUMP
// Global refinement drawn as triangles (FAS section 8.1): two of each quad of the last level, at limit points.
#extension GL_GOOGLE_include_directive : require
#include "shared/surface.glsl"
#include "shared/tex_tree.glsl"
#include "shared/colors.glsl"
#include "shared/motion.glsl"

const uint CORNERS[6] = uint[6](0, 1, 2, 0, 2, 3);

void main()
{
    uint quad = gl_VertexIndex / 6;
    uint corner = CORNERS[gl_VertexIndex % 6];
    FillingQuads quads = FillingQuads(push.patches);
    uint limit_index = quads.v[quad].corners[corner];
    LimitPoint limit = LimitPoints(push.points).v[limit_index];
    PatchInfo info = quads.v[quad].info;
    vec2 uv = vec2(corner == 1 || corner == 2, corner >= 2);
    vec2 st = vec2(0.0);
    if (TEX_COORDS) {
        SceneTables scene = push.frame.v.scene;
        st = tree_tex_coord(scene, scene.v.objects.v[0], info.ptex_face, ptex_uv(info, uv));
    }
    put_surface_point(limit.position, limit.normal, limit.normal, uv, st, info, push.first_patch_id + quad, KIND_FILLING, 1.0);
    put_object(0u);
    if (COLORED) {
        SceneTables scene = push.frame.v.scene;
        put_color(limit_color(scene, scene.v.objects.v[0], limit_index, info.ptex_face, ptex_uv(info, uv)));
    }
    if (MOVING) {
        SceneTables scene = push.frame.v.scene;
        put_next_position(next_limit(scene, scene.v.objects.v[0], limit_index, limit.position));
    }
}
