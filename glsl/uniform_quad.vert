#version 460
// variants: lean=LEAN layers=LAYERS dump=DUMP
// Global refinement drawn as triangles (FAS section 8.1): two of each quad of the last level, at limit points.
#extension GL_GOOGLE_include_directive : require
#include "shared/surface.glsl"
#include "shared/tex_tree.glsl"

const uint CORNERS[6] = uint[6](0, 1, 2, 0, 2, 3);

void main()
{
    uint quad = gl_VertexIndex / 6;
    uint corner = CORNERS[gl_VertexIndex % 6];
    FillingQuads quads = FillingQuads(push.patches);
    LimitPoint limit = LimitPoints(push.points).v[quads.v[quad].corners[corner]];
    vec2 uv = vec2(corner == 1 || corner == 2, corner >= 2);
    vec2 st = vec2(0.0);
    if (TEX_COORDS) {
        SceneTables scene = push.frame.v.scene;
        PatchInfo info = quads.v[quad].info;
        st = tree_tex_coord(scene, scene.v.objects.v[0], info.ptex_face, ptex_uv(info, uv));
    }
    put_surface_point(limit.position, limit.normal, limit.normal, uv, st, quads.v[quad].info, push.first_patch_id + quad, KIND_FILLING, 1.0);
}
