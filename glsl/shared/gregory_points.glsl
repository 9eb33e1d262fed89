// All control points of a Gregory patch for one thread, with the bits that the control shader makes one by one. CPU twin:
// crates/render/src/gregory_points.rs.
#ifndef PLANISH_GREGORY_POINTS
#define PLANISH_GREGORY_POINTS
#include "gregory.glsl"
#include "stencil.glsl"

precise vec3 add_weighted(vec3 sum, float weight, vec3 point, vec3 origin)
{
    precise vec3 offset = point - origin;
    precise vec3 result = sum + weight * offset;
    return result;
}

precise vec3 sum_of(vec3 a, vec3 b)
{
    precise vec3 result = a + b;
    return result;
}

// The control points of a patch by its stencil, with the bits that stencil_point makes: the ring is gone over once.
void stencil_points(SceneTables scene, GregoryFace face, uint place, uint corners, out vec3 p[20])
{
    GregoryStencil stencil = scene.v.stencils.v[place];
    vec3 origins[4];
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        uint corner = i < corners ? i : 0u;
        origins[i] = scene.v.points.v[stencil.corners[corner]];
        p[5u * i] = scene.v.limits.v[face.limits[corner]].position;
        [[unroll]] for (uint which = 1u; which < 5u; ++which) {
            p[5u * i + which] = vec3(0.0);
        }
    }
    for (uint k = 0u; k < stencil.point_count; ++k) {
        uvec3 entry = scene.v.stencil_points.v[stencil.first_point + k];
        uint column = stencil.first_weight + entry.y * 8u * corners;
        vec3 point = scene.v.points.v[entry.x];
        [[unroll]] for (uint row = 0u; row < 16u; ++row) {
            float weight = scene.v.stencil_weights.v[column + min(row, 4u * corners - 1u)];
            uint i = 5u * (row / 4u) + row % 4u + 1u;
            p[i] = add_weighted(p[i], weight, point, origins[row / 4u]);
        }
    }
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        [[unroll]] for (uint which = 1u; which < 5u; ++which) {
            p[5u * i + which] = sum_of(origins[i], p[5u * i + which]);
        }
    }
    for (bool is_open = stencil.spoke_edges != 0u; is_open; is_open = false) {
        [[dont_unroll]] for (uint i = 0u; i < corners; ++i) {
            uint previous = i == 0u ? corners - 1u : i - 1u;
            if ((stencil.spoke_edges >> i & 1u) != 0u) {
                p[5u * i + 1u] = scene.v.spokes.v[face.first[i]].edge;
            }
            if ((stencil.spoke_edges >> previous & 1u) != 0u) {
                p[5u * i + 2u] = scene.v.spokes.v[face.last[previous]].edge;
            }
        }
    }
}

// The control points of a patch in world space. Those of a third of a triangle begin at its corner; the last five are its first again.
void gregory_points(SceneTables scene, Object object, GregoryFace face, uint place, out vec3 p[20])
{
    uint kind = gregory_kind(face);
    bool is_triangle = kind == GREGORY_TRIANGLE;
    bool is_stencil = has_stencil(scene, place);
    uint corners = is_triangle ? 3u : 4u;
    vec3 made[20];
    if (STENCIL) {
        for (bool is_open = is_stencil; is_open; is_open = false) {
            stencil_points(scene, face, place, corners, made);
        }
    }
    uint first = is_triangle ? 5u * gregory_part(face) : 0u;
    [[dont_unroll]] for (uint i = 0u; i < 20u; ++i) {
        uint at = i < 5u * corners ? (first + i) % (5u * corners) : first;
        vec3 point = made[at];
        for (bool is_open = kind == GREGORY_NGON; is_open; is_open = false) {
            point = ngon_point(scene, face, at);
        }
        for (bool is_open = !is_stencil && kind != GREGORY_NGON; is_open; is_open = false) {
            point = corner_point(scene, face, at, corners);
        }
        p[i] = to_world(object, point);
    }
}

// Whether a bicubic patch with a semi-sharp crease lies across an edge: where it decides, the edge is not that of the control points.
bool has_creased_border(SceneTables scene, GregoryFace face)
{
    bool result = false;
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        uint border = face.borders[i];
        for (bool is_open = border != NONE; is_open; is_open = false) {
            result = result || scene.v.patches.v[border >> 5].sharpness != 0.0;
        }
    }
    return result;
}
#endif
