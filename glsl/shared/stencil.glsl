// Control points of Gregory patches as weighted sums of the cage's points (Loop et al. 2009, section 4.3). CPU twin:
// crates/subdiv/src/gregory/surface.rs.
#ifndef PLANISH_STENCIL
#define PLANISH_STENCIL
#include "scene.glsl"

// Whether faces have stencils at all.
layout(constant_id = 12) const bool STENCIL = false;

bool has_stencil(SceneTables scene, uint place)
{
    return STENCIL && scene.v.stencils.v[place].point_count != 0u;
}

// Two rows at once, relative to their origins, in the order of points that all patches have. Points without a weight in either are
// skipped by the ring's masks; adding what has none in one of them changes no bit.
void weigh_ring(SceneTables scene, GregoryStencil stencil, uint row_count, uvec2 rows, vec3 origin0, vec3 origin1, out precise vec3 sum0,
                out precise vec3 sum1)
{
    precise vec3 made0 = vec3(0.0);
    precise vec3 made1 = vec3(0.0);
    for (uint i = 0u; i < stencil.point_count; ++i) {
        uvec3 entry = scene.v.stencil_points.v[stencil.first_point + i];
        if ((entry.z >> rows.x & 1u) == 0u && (entry.z >> rows.y & 1u) == 0u) {
            continue;
        }
        uint column = stencil.first_weight + entry.y * row_count;
        vec3 point = scene.v.points.v[entry.x];
        precise vec3 offset0 = point - origin0;
        precise vec3 offset1 = point - origin1;
        made0 = made0 + scene.v.stencil_weights.v[column + rows.x] * offset0;
        made1 = made1 + scene.v.stencil_weights.v[column + rows.y] * offset1;
    }
    sum0 = made0;
    sum1 = made1;
}

// Control point i of a quad or a triangle, and of the vectors across edges number i: e+ and e- of an edge that is shared with a patch that
// is made of spokes are the spokes', as are the vectors across.
void stencil_point(SceneTables scene, GregoryFace face, uint place, uint i, uint corners, out vec3 point, out vec3 across)
{
    GregoryStencil stencil = scene.v.stencils.v[place];
    uint corner = min(i / 5u, corners - 1u);
    uint which = i % 5u;
    uint edge = min(i / 4u, corners - 1u);
    uint next = edge + 1u == corners ? 0u : edge + 1u;
    uint seat = (i & 2u) == 0u ? edge : next;
    vec3 origin = scene.v.points.v[stencil.corners[corner]];
    uvec2 rows = uvec2(4u * corner + max(which, 1u) - 1u, 4u * corners + 4u * edge + (i & 3u));
    precise vec3 offset;
    precise vec3 made_across;
    weigh_ring(scene, stencil, 8u * corners, rows, origin, scene.v.points.v[stencil.corners[seat]], offset, made_across);
    precise vec3 made = origin + offset;
    point = which == 0u ? scene.v.limits.v[face.limits[corner]].position : made;
    across = made_across;
    for (bool is_open = stencil.spoke_edges != 0u; is_open; is_open = false) {
        uint previous = corner == 0u ? corners - 1u : corner - 1u;
        bool is_out = (which & 1u) != 0u;
        bool is_spoke = (stencil.spoke_edges >> (is_out ? corner : previous) & 1u) != 0u && (which == 1u || which == 2u);
        if (is_spoke) {
            point = scene.v.spokes.v[is_out ? face.first[corner] : face.last[previous]].edge;
        }
        if ((stencil.spoke_edges >> edge & 1u) != 0u) {
            EdgeFields fields = edge_fields(scene, face.limits[edge], face.first[edge], face.last[edge], face.limits[next]);
            across = fields.across[i & 3u];
        }
    }
}
#endif
