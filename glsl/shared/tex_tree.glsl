// Texture coordinates of surfaces that nothing displaces: looked up in a quadtree for each Ptex face, as the channel is irregular
// elsewhere than the surface. Layout: planish_subdiv's TexTree.
#ifndef PLANISH_TEX_TREE
#define PLANISH_TEX_TREE
#include "scene.glsl"

const uint TEX_PATCH = 1;
const uint TEX_QUAD = 2;

// Texture coordinates at a point, and their derivatives along u and v.
struct TexPoint {
    vec2 at;
    vec2 along_u;
    vec2 along_v;
};

// At (u, v) of a Ptex face, 0 where there are none.
TexPoint tree_tex_point(SceneTables scene, Object object, uint ptex_face, vec2 uv)
{
    TexPoint result = TexPoint(vec2(0.0), vec2(0.0), vec2(0.0));
    float scale = 1.0;
    uint branch = scene.v.tex_roots.v[object.first_ptex + ptex_face];
    [[dont_unroll]] for (uint depth = 0u; depth < LEVEL_COUNT && branch >> 30 == 0u; ++depth) {
        uvec2 quarter = uvec2(greaterThanEqual(uv, vec2(0.5)));
        uv = 2.0 * uv - vec2(quarter);
        scale *= 2.0;
        uint child = quarter.y == 0u ? quarter.x : 3u - quarter.x;
        branch = scene.v.tex_nodes.v[4u * branch + child];
    }
    if (branch == NONE) {
        return result;
    }
    uint index = branch & 0x3fffffffu;
    if (branch >> 30 == TEX_QUAD) {
        vec2 p[4];
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            p[i] = scene.v.tex_coords.v[scene.v.face_tex_coords.v[4u * index + i]];
        }
        vec2 rest = 1.0 - uv;
        precise vec2 at = rest.y * (rest.x * p[0] + uv.x * p[1]) + uv.y * (rest.x * p[3] + uv.x * p[2]);
        result.at = at;
        result.along_u = scale * (rest.y * (p[1] - p[0]) + uv.y * (p[2] - p[3]));
        result.along_v = scale * (rest.x * (p[3] - p[0]) + uv.x * (p[2] - p[1]));
        return result;
    }
    vec3 p[16];
    [[unroll]] for (uint i = 0u; i < 16u; ++i) {
        p[i] = vec3(scene.v.tex_coords.v[scene.v.patch_tex_coords.v[16u * index + i]], 0.0);
    }
    vec4 nu;
    vec4 nv;
    vec4 du;
    vec4 dv;
    cubic_basis(uv.x, 1.0 - uv.x, nu, du);
    cubic_basis(uv.y, 1.0 - uv.y, nv, dv);
    precise vec3 at = weigh_patch(p, nu, nv) / 36.0;
    result.at = at.xy;
    result.along_u = weigh_patch(p, du, nv).xy * (scale / 12.0);
    result.along_v = weigh_patch(p, nu, dv).xy * (scale / 12.0);
    return result;
}

vec2 tree_tex_coord(SceneTables scene, Object object, uint ptex_face, vec2 uv)
{
    return tree_tex_point(scene, object, ptex_face, uv).at;
}
#endif
