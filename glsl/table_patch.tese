#version 460
// variants: lean=LEAN layers=LAYERS colors=LAYERS,COLORS shading=SHADING dump=DUMP
// Faces that are evaluated by table (Hollaender and Boubekeur 2010): each point of the grid is a row. Points of edges and corners are
// those of the edge and of the vertex, whichever face asks. Substitutes that the paper compares with have the same grid.
#extension GL_GOOGLE_include_directive : require
#include "shared/substitutes.glsl"
#include "shared/table_factors.glsl"
#include "shared/tex_tree.glsl"
#include "shared/colors.glsl"
#include "shared/motion.glsl"
#include "shared/surface.glsl"

layout(quads, equal_spacing, ccw) in;
layout(location = 0) patch in vec4 edge_factors;
layout(location = 1) patch in uvec4 patch_words; // place of the patch, of its object, its number, segments

// Where a point of the grid lies: on an edge (4: on none), at a place along it from its first corner on, of so many.
struct GridPlace {
    uvec2 at;       // in the grid
    uint edge;
    uint along;
    uint segments;
};

// The quad's upper half is folded onto a triangle's long edge: it makes triangles without area.
GridPlace grid_place(uvec2 at, uint segments, bool is_triangle)
{
    if (is_triangle) {
        at.y = min(at.y, segments - at.x);
    }
    GridPlace result = GridPlace(at, 4u, 0u, segments);
    if (at.y == 0u) {
        result.edge = 0u;
        result.along = at.x;
    } else if (is_triangle ? at.x + at.y == segments : at.x == segments) {
        result.edge = 1u;
        result.along = at.y;
    } else if (!is_triangle && at.y == segments) {
        result.edge = 2u;
        result.along = segments - at.x;
    } else if (at.x == 0u) {
        result.edge = is_triangle ? 2u : 3u;
        result.along = segments - at.y;
    }
    if (result.edge < 4u) {
        // Points that the edge does not have lie on those before.
        result.segments = table_segments(edge_factors[result.edge]);
        result.along = result.along * result.segments / segments;
    }
    return result;
}

// The grid point that a place along an edge is, with the table's most segments.
uvec2 edge_grid(uint edge, uint along, uint segments, bool is_triangle)
{
    if (edge == 0u) {
        return uvec2(along, 0u);
    }
    if (is_triangle) {
        return edge == 1u ? uvec2(segments - along, along) : uvec2(0u, segments - along);
    }
    return edge == 1u ? uvec2(segments, along) : (edge == 2u ? uvec2(segments - along, segments) : uvec2(0u, segments - along));
}

// Rows of a triangle hold one point less each.
uint patch_row(uvec2 at, uint most, bool is_triangle)
{
    return is_triangle ? at.y * (most + 1u) - (at.y * (at.y - 1u)) / 2u + at.x : at.y * (most + 1u) + at.x;
}

TableRange patch_range(TablePatch face) { return TableRange(face.first_control, face.control_count, face.first_weight); }

Corners corners_of(SceneTables scene, TablePatch face)
{
    Corners result;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        uint point = scene.v.table_controls.v[face.first_control + min(i, face.control_count - 1u)];
        result.position[i] = scene.v.points.v[point];
        result.normal[i] = scene.v.table_normals.v[point];
    }
    return result;
}

// A point of the table's finest grid.
TablePoint patch_point(SceneTables scene, TablePatch face, uvec2 at, uint most)
{
    bool is_triangle = is_table_triangle(face.flags);
    if (EVALUATE != EVALUATE_TABLE) {
        return substitute_point(corners_of(scene, face), corner_weights(vec2(at) / float(most), is_triangle));
    }
    return table_row(scene, patch_range(face), patch_row(at, most, is_triangle));
}

// Normals of the mesh that was split, between the corners.
vec3 interpolated_normal(SceneTables scene, TablePatch face, uvec2 at, uint most)
{
    bool is_triangle = is_table_triangle(face.flags);
    vec3 normal[4];
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        normal[i] = scene.v.limits.v[face.corners[i]].normal;
    }
    if (is_triangle) {
        normal[3] = vec3(0.0);
    }
    return unit_vector(mixed(normal, corner_weights(vec2(at) / float(most), is_triangle)));
}

// A point of an edge's table, or the limit point at its end. Where the surface is not smooth the normal is the face's own.
TablePoint edge_row(SceneTables scene, TablePatch face, GridPlace place, uint along, uint most)
{
    bool is_triangle = is_table_triangle(face.flags);
    uint stride = most / place.segments;
    TablePoint result;
    if (EVALUATE != EVALUATE_TABLE) {
        return patch_point(scene, face, edge_grid(place.edge, along * stride, most, is_triangle), most);
    }
    bool is_corner = along == 0u || along == place.segments;
    uint end = place.edge + (along == 0u ? 0u : 1u);
    end = end == (is_triangle ? 3u : 4u) ? 0u : end;
    bool has_own = NORMALS == NORMALS_TANGENTS && (face.flags >> (is_corner ? 4u + end : place.edge) & 1u) != 0u;
    for (bool is_open = is_corner; is_open; is_open = false) {
        LimitPoint limit = scene.v.limits.v[face.corners[end & 3u]];
        result = TablePoint(limit.position, limit.normal);
    }
    for (bool is_open = !is_corner; is_open; is_open = false) {
        uint edge = face.edges[place.edge & 3u];
        TableEdge table = scene.v.table_edges.v[edge >> 1];
        uint from_first = (edge & 1u) != 0u ? place.segments - along : along;
        result = table_row(scene, TableRange(table.first_control, table.control_count, table.first_weight), from_first * stride);
    }
    for (bool is_open = has_own; is_open; is_open = false) {
        result.normal = patch_point(scene, face, edge_grid(place.edge, along * stride, most, is_triangle), most).normal;
    }
    if (NORMALS == NORMALS_GEOMETRIC) {
        result.normal = interpolated_normal(scene, face, edge_grid(place.edge, along * stride, most, is_triangle), most);
    }
    return result;
}

TablePoint edge_point(SceneTables scene, TablePatch face, GridPlace place, uint most)
{
    TablePoint own = edge_row(scene, face, place, place.along, most);
    float morph = table_morph(edge_factors[place.edge], place.segments);
    for (bool is_open = (place.along & 1u) != 0u && morph < 1.0; is_open; is_open = false) {
        TablePoint before = edge_row(scene, face, place, place.along - 1u, most);
        TablePoint after = edge_row(scene, face, place, place.along + 1u, most);
        own = table_between(table_middle(before, after), own, morph);
    }
    return own;
}

TablePoint inner_point(SceneTables scene, TablePatch face, GridPlace place, uint most)
{
    bool is_triangle = is_table_triangle(face.flags);
    uint stride = most / place.segments;
    TablePoint own = patch_point(scene, face, place.at * stride, most);
    float morph = table_morph(largest_factor(edge_factors), place.segments);
    uvec2 odd = place.at & 1u;
    for (bool is_open = odd != uvec2(0u) && morph < 1.0; is_open; is_open = false) {
        // In the middle of a coarser edge; of a coarser quad, too.
        ivec2 way = is_triangle && odd == uvec2(1u) ? ivec2(1, -1) : ivec2(odd);
        TablePoint middle = table_middle(patch_point(scene, face, uvec2(ivec2(place.at) - way) * stride, most),
                                         patch_point(scene, face, uvec2(ivec2(place.at) + way) * stride, most));
        if (!is_triangle && odd == uvec2(1u)) {
            way = ivec2(1, -1);
            middle = table_middle(middle, table_middle(patch_point(scene, face, uvec2(ivec2(place.at) - way) * stride, most),
                                                       patch_point(scene, face, uvec2(ivec2(place.at) + way) * stride, most)));
        }
        own = table_between(middle, own, morph);
    }
    if (EVALUATE == EVALUATE_TABLE && NORMALS == NORMALS_GEOMETRIC) {
        own.normal = interpolated_normal(scene, face, place.at * stride, most);
    }
    return own;
}

// Where the point is at the next moment, in the mesh's own space; whole points of the table alone.
vec3 next_point(SceneTables scene, TablePatch face, uvec2 at, uint most)
{
    return next_table_row(scene, patch_range(face), patch_row(at, most, is_table_triangle(face.flags)));
}

// Colours that are linear in a triangle.
vec3 triangle_color(SceneTables scene, Object object, uint ptex_face, vec2 uv)
{
    uvec4 slots = corner_slots(scene, object, ptex_face) + object.first_mesh_slot;
    return (1.0 - uv.x - uv.y) * scene.v.slot_colors.v[slots.x] + uv.x * scene.v.slot_colors.v[slots.y]
        + uv.y * scene.v.slot_colors.v[slots.z];
}

// Parameters on the Ptex face.
vec2 table_uv(TablePatch face, vec2 uv, uint steps)
{
    bool is_triangle = is_table_triangle(face.flags);
    vec2 origin = table_corner_uv(face.corner_uvs, 0u, steps);
    vec2 along_u = table_corner_uv(face.corner_uvs, 1u, steps) - origin;
    vec2 along_v = table_corner_uv(face.corner_uvs, is_triangle ? 2u : 3u, steps) - origin;
    return origin + uv.x * along_u + uv.y * along_v;
}

void main()
{
    SceneTables scene = push.frame.v.scene;
    TablePatch face = scene.v.table_patches.v[patch_words.x];
    Object object = scene.v.objects.v[patch_words.y];
    uint segments = patch_words.w;
    uint most = 1u << scene.v.table_level;
    bool is_triangle = is_table_triangle(face.flags);
    GridPlace place = grid_place(uvec2(round(float(segments) * gl_TessCoord.xy)), segments, is_triangle);
    TablePoint point;
    uvec2 at = place.at * (most / segments);
    for (bool is_open = place.edge < 4u; is_open; is_open = false) {
        point = edge_point(scene, face, place, most);
        at = edge_grid(place.edge, place.along * (most / place.segments), most, is_triangle);
    }
    for (bool is_open = place.edge == 4u; is_open; is_open = false) {
        point = inner_point(scene, face, place, most);
    }
    vec3 position = without_sign_of_zero(to_world(object, point.position));
    vec3 normal = without_sign_of_zero(normal_to_world(object, point.normal));
    vec2 uv = table_uv(face, vec2(at) / float(most), scene.v.table_steps);
    // The parameters are those of the whole Ptex face.
    PatchInfo info = PatchInfo(object.first_face + face.ptex_face, 0u, scene.v.table_steps << 5);
    vec2 st = vec2(0.0);
#if defined(SHADING) || defined(DUMP) || defined(COLORS)
    if (TEX_COORDS) {
        st = tree_tex_coord(scene, object, face.ptex_face, uv);
    }
#endif
    put_surface_point(position, normal, normal, uv, st, info, patch_words.z, KIND_TABLE, largest_factor(edge_factors));
    put_object(patch_words.y);
#if defined(COLORS) || defined(SHADING) || defined(DUMP)
    if (COLORED) {
        for (bool is_open = (object.flags & OBJECT_VARYING_COLORS) != 0u; is_open; is_open = false) {
            put_color(is_triangle ? triangle_color(scene, object, face.ptex_face, uv) : varying_color(scene, object, face.ptex_face, uv));
        }
    }
#endif
    if (MOVING) {
        vec3 next = position;
        for (bool is_open = EVALUATE == EVALUATE_TABLE && (object.flags & OBJECT_DEFORMS) != 0u; is_open; is_open = false) {
            next = next_point(scene, face, at, most);
        }
        put_next_position(moved_on(object, next));
    }
}
