// Where the displacement of a point of a bicubic patch is looked up. Included after border.glsl, where `push` is declared.
#ifndef PLANISH_PATCH_MAPS
#define PLANISH_PATCH_MAPS
#include "displacement.glsl"
#include "tex_tree.glsl"

precise float between_corners(vec4 at, Parameter u, Parameter v)
{
    precise float low = u.s * at.x + u.t * at.y;
    precise float high = u.s * at.w + u.t * at.z;
    precise float result = v.s * low + v.t * high;
    return result;
}

// Texture coordinates at a point of a bicubic patch; their derivatives are times 12, as the patch's tangents. `n` and `d` are the
// weights there.
TexPoint tex_point(Object object, uint place, Parameter u, Parameter v, vec4 nu, vec4 du, vec4 nv, vec4 dv)
{
    SceneTables scene = push.frame.v.scene;
    TexPoint result = TexPoint(vec2(0.0), vec2(0.0), vec2(0.0));
    if (scene.v.patch_tex_coords.v[16u * place] == NONE) {
        return result;
    }
    vec3 p[16];
    [[unroll]] for (uint i = 0u; i < 16u; ++i) {
        p[i] = vec3(scene.v.tex_coords.v[scene.v.patch_tex_coords.v[16u * place + i]], 0.0);
    }
    result.along_u = weigh_patch(p, du, nv).xy;
    result.along_v = weigh_patch(p, nu, dv).xy;
    // Of bilinear coordinates the rows outside are extrapolations, other ones on each side of an edge.
    if ((object.flags & OBJECT_LINEAR_TEX_COORDS) != 0u) {
        result.at = vec2(between_corners(vec4(p[5].x, p[6].x, p[10].x, p[9].x), u, v),
                         between_corners(vec4(p[5].y, p[6].y, p[10].y, p[9].y), u, v));
    } else {
        result.at = patch_position(p, nu, nv).xy;
    }
    result.at = without_sign_of_zero(vec3(result.at, 0.0)).xy;
    return result;
}

// Where the displacement of a point is looked up, but for its texture coordinates, and its level of detail.
MapPlace map_place(Object object, uint place, Parameter u, Parameter v, out float lod)
{
    PatchInfo info = push.patches.v[place].info;
    MapPlace result;
    result.ptex_face = info.ptex_face;
    ptex_place(info, u, v, result.u, result.v);
    SceneTables scene = push.frame.v.scene;
    lod = between_corners(corner_densities(face_lods(scene, object, info.ptex_face), info), u, v);
    return result;
}
#endif
