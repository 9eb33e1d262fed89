// Texture coordinates of surfaces that nothing displaces: looked up in a quadtree for each Ptex face, as the channel is irregular
// elsewhere than the surface. Layout: planish_subdiv's TexTree.
#ifndef PLANISH_TEX_TREE
#define PLANISH_TEX_TREE
#include "scene.glsl"

const uint TEX_PATCH = 1;
const uint TEX_QUAD = 2;

// At (u, v) of a Ptex face, 0 where there are none.
vec2 tree_tex_coord(SceneTables scene, Object object, uint ptex_face, vec2 uv)
{
    uint branch = scene.v.tex_roots.v[object.first_ptex + ptex_face];
    [[dont_unroll]] for (uint depth = 0u; depth < LEVEL_COUNT && branch >> 30 == 0u; ++depth) {
        uvec2 quarter = uvec2(greaterThanEqual(uv, vec2(0.5)));
        uv = 2.0 * uv - vec2(quarter);
        uint child = quarter.y == 0u ? quarter.x : 3u - quarter.x;
        branch = scene.v.tex_nodes.v[4u * branch + child];
    }
    if (branch == NONE) {
        return vec2(0.0);
    }
    uint index = branch & 0x3fffffffu;
    if (branch >> 30 == TEX_QUAD) {
        vec2 p[4];
        [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
            p[i] = scene.v.tex_coords.v[scene.v.face_tex_coords.v[4u * index + i]];
        }
        vec2 rest = 1.0 - uv;
        return rest.y * (rest.x * p[0] + uv.x * p[1]) + uv.y * (rest.x * p[3] + uv.x * p[2]);
    }
    vec3 p[16];
    [[dont_unroll]] for (uint i = 0u; i < 16u; ++i) {
        p[i] = vec3(scene.v.tex_coords.v[scene.v.patch_tex_coords.v[16u * index + i]], 0.0);
    }
    vec4 nu;
    vec4 nv;
    vec4 slope;
    cubic_basis(uv.x, 1.0 - uv.x, nu, slope);
    cubic_basis(uv.y, 1.0 - uv.y, nv, slope);
    return weigh_patch(p, nu, nv).xy / 36.0;
}
#endif
