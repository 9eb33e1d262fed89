// Displacement maps, filtered by hand: two threads that look at the same place get the same bits on any device, which texture
// units do not promise, and weights have all the digits of a float instead of 8 bits. CPU twin:
// crates/scene/src/displacement/sample.rs, the same operations in the same order.
#ifndef PLANISH_DISPLACEMENT
#define PLANISH_DISPLACEMENT
#include "density.glsl"
#include "spacing.glsl"

// The texels beside a parameter, and their weights.
struct TexelPair {
    uvec2 texels;
    vec2 weights;
};

precise vec3 mix_texels(vec3 a, vec3 b, vec2 weights)
{
    precise vec3 result = weights.x * a + weights.y * b;
    return result;
}

vec3 texel_at(DisplacementMap map, uint texel)
{
    uint at = texel * map.channels;
    return map.channels == 1u ? vec3(map.texels.v[at], 0.0, 0.0)
                              : vec3(map.texels.v[at], map.texels.v[at + 1u], map.texels.v[at + 2u]);
}

TexelPair from_end(float parameter, uint segments)
{
    precise float x = parameter * float(segments);
    precise float cell = min(floor(x), float(segments - 1u));
    precise float t = x - cell;
    precise float s = 1.0 - t;
    return TexelPair(uvec2(uint(cell), uint(cell) + 1u), vec2(s, t));
}

// Counted from the end that is nearer: the same for those who count from the other end.
TexelPair whole_edge(Parameter at, uint end)
{
    if (at.t <= at.s) {
        return from_end(at.t, end);
    }
    TexelPair result = from_end(at.s, end);
    result.texels = uvec2(end) - result.texels;
    return result;
}

// On a side that is half of an edge, at the texels of the whole one.
TexelPair half_edge(float parameter, uint end)
{
    TexelPair result = from_end(parameter, end / 2u);
    result.texels *= 2u;
    return result;
}

TexelPair centered(DisplacementMap map, float parameter, uint count)
{
    precise float x = parameter * float(count) - 0.5;
    precise float cell = floor(x);
    precise float t = x - cell;
    precise float s = 1.0 - t;
    int before = int(cell);
    int last = int(count) - 1;
    ivec2 texels = ivec2(before, before + 1);
    if (map.layout_kind == LAYOUT_REPEAT) {
        texels = ivec2(before < 0 ? last : min(before, last), texels.y > last ? 0 : texels.y);
    } else {
        texels = clamp(texels, ivec2(0), ivec2(last));
    }
    return TexelPair(uvec2(texels), vec2(s, t));
}

vec3 bilinear(DisplacementMap map, uint first_texel, uint width, TexelPair columns, TexelPair rows)
{
    uint low = first_texel + rows.texels.x * width;
    uint high = first_texel + rows.texels.y * width;
    vec3 a = mix_texels(texel_at(map, low + columns.texels.x), texel_at(map, low + columns.texels.y), columns.weights);
    vec3 b = mix_texels(texel_at(map, high + columns.texels.x), texel_at(map, high + columns.texels.y), columns.weights);
    return mix_texels(a, b, rows.weights);
}

uint tile_number(DisplacementMap map, vec2 tile)
{
    if (tile.x >= 0.0 && tile.x < float(map.tile_columns) && tile.y >= 0.0 && tile.y < float(map.tile_rows)) {
        return map.tile_of.v[uint(tile.y) * map.tile_columns + uint(tile.x)];
    }
    return NONE;
}

// The tile that texture coordinates are in, NONE for none, and where in it they are. A coordinate on the border of two tiles
// is in the latter if that exists.
uint tile_at(DisplacementMap map, vec2 uv, out precise vec2 inside)
{
    vec2 corner = floor(uv);
    inside = uv - corner;
    if (map.layout_kind == LAYOUT_REPEAT) {
        return 0u;
    }
    uint found = NONE;
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        vec2 back = vec2(i & 1u, i >> 1);
        bool is_there = (back.x == 0.0 || uv.x == corner.x) && (back.y == 0.0 || uv.y == corner.y);
        precise vec2 other = corner - back;
        uint tile = is_there && found == NONE ? tile_number(map, other) : NONE;
        if (tile != NONE) {
            found = tile;
            inside = uv - other;
        }
    }
    return found;
}

// Where a displacement is looked up: texture coordinates, or a place in a Ptex face.
struct MapPlace {
    vec2 uv;
    uint ptex_face;
    Parameter u;
    Parameter v;
};

vec3 sample_level(DisplacementMap map, MapPlace place, uint tile, vec2 inside, uint level)
{
    if (map.layout_kind != LAYOUT_FACES) {
        MapLevel at = map.levels.v[map.tiles.v[tile].first_level + level];
        precise float down = 1.0 - inside.y;
        return bilinear(map, at.first_texel, at.width, centered(map, inside.x, at.width), centered(map, down, at.height));
    }
    MapLevel at = map.levels.v[level];
    uint end = at.width - 1u;
    uint first = at.first_texel + place.ptex_face * at.width * at.width;
    bool is_part = (map.parts.v[place.ptex_face >> 5] >> (place.ptex_face & 31u) & 1u) != 0u;
    if (place.v.t == 0.0 || place.v.s == 0.0) {
        uint row = first + (place.v.t == 0.0 ? 0u : end) * at.width;
        TexelPair pair = is_part && place.v.t == 0.0 ? half_edge(place.u.t, end) : whole_edge(place.u, end);
        return mix_texels(texel_at(map, row + pair.texels.x), texel_at(map, row + pair.texels.y), pair.weights);
    }
    if (place.u.t == 0.0 || place.u.s == 0.0) {
        uint column = first + (place.u.t == 0.0 ? 0u : end);
        TexelPair pair = is_part && place.u.t == 0.0 ? half_edge(place.v.t, end) : whole_edge(place.v, end);
        return mix_texels(texel_at(map, column + pair.texels.x * at.width), texel_at(map, column + pair.texels.y * at.width),
                          pair.weights);
    }
    return bilinear(map, first, at.width, whole_edge(place.u, end), whole_edge(place.v, end));
}

// The displacement of a map at a level of detail, 0 being the finest: between two levels where it is not whole.
vec3 sample_map(DisplacementMap map, MapPlace place, float lod)
{
    vec2 inside = vec2(0.0);
    uint tile = 0u;
    uint level_count = map.level_count;
    if (map.layout_kind != LAYOUT_FACES) {
        tile = tile_at(map, place.uv, inside);
        if (tile == NONE) {
            return vec3(0.0);
        }
        level_count = map.tiles.v[tile].level_count;
    }
    lod = lod > 0.0 ? min(lod, float(level_count - 1u)) : 0.0;
    float finer = floor(lod);
    precise float t = lod - finer;
    precise float s = 1.0 - t;
    vec3 levels[2];
    uint count = t != 0.0 ? 2u : 1u;
    [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
        levels[i] = sample_level(map, place, tile, inside, uint(finer) + i);
    }
    return count == 2u ? mix_texels(levels[0], levels[1], vec2(s, t)) : levels[0];
}

// A displacement, and how it changes around: along texture coordinates, or parameters of the Ptex face.
struct MapSamples {
    vec3 value;
    vec3 along_s;
    vec3 along_t;
};

// The value at a place; changes around another one, by differences over two texels. A loop, so that drivers compile the filter once.
MapSamples sample_around(DisplacementMap map, MapPlace place, MapPlace middle, float lod)
{
    vec2 step = map.texel * exp2(max(lod, 0.0));
    MapSamples result = MapSamples(vec3(0.0), vec3(0.0), vec3(0.0));
    vec2 at = map.layout_kind == LAYOUT_FACES ? vec2(middle.u.t, middle.v.t) : middle.uv;
    vec4 ends = vec4(at - step, at + step);
    if (map.layout_kind == LAYOUT_FACES) {
        ends = clamp(ends, 0.0, 1.0);
    }
    [[dont_unroll]] for (uint i = 0u; i < 5u; ++i) {
        MapPlace looked_up = place;
        if (i != 0u) {
            // Low s, high s, low t, high t.
            bool is_s = i <= 2u;
            float end = i == 1u ? ends.x : (i == 2u ? ends.z : (i == 3u ? ends.y : ends.w));
            looked_up = middle;
            looked_up.uv = is_s ? vec2(end, middle.uv.y) : vec2(middle.uv.x, end);
            if (is_s) {
                looked_up.u = Parameter(end, 1.0 - end);
            } else {
                looked_up.v = Parameter(end, 1.0 - end);
            }
        }
        vec3 found = sample_map(map, looked_up, lod);
        if (i == 0u) {
            result.value = found;
        } else if (i <= 2u) {
            result.along_s += i == 1u ? -found : found;
        } else {
            result.along_t += i == 3u ? -found : found;
        }
    }
    result.along_s /= ends.z - ends.x;
    result.along_t /= ends.w - ends.y;
    return result;
}

// Levels of detail at the corners of a Ptex face, as densities are known there: log2 of texels over segments along an edge.
FaceDensity face_lods(SceneTables scene, Object object, uint ptex_face)
{
    uvec4 slots = corner_slots(scene, object, ptex_face);
    FaceDensity result;
    result.is_part = (slots.z & PART_OF_FACE) != 0u;
    slots.z &= ~PART_OF_FACE;
    for (int corner = 0; corner < 4; ++corner) {
        float density = max(scene.v.densities.v[object.first_slot + slots[corner]].density, 1e-3);
        result.at[corner] = log2(max(scene.v.texel_counts.v[object.first_mesh_slot + slots[corner]] / density, 1.0));
    }
    return result;
}

// The place in its Ptex face of a point of a patch, with what is left to 1: exchanged, they are those of the face across.
void ptex_place(PatchInfo info, Parameter u, Parameter v, out Parameter ptex_u, out Parameter ptex_v)
{
    uint last = (1u << patch_depth(info)) - 1u;
    float scale = halvings(patch_depth(info));
    uvec2 corner = uvec2(info.corner & 0xffffu, info.corner >> 16);
    precise vec2 along_u = (vec2(corner.x, last - corner.x) + vec2(u.t, u.s)) * scale;
    precise vec2 along_v = (vec2(corner.y, last - corner.y) + vec2(v.t, v.s)) * scale;
    ptex_u = Parameter(along_u.x, along_u.y);
    ptex_v = Parameter(along_v.x, along_v.y);
}

// The vector of a displacement in world space: along the direction of displacement, or as a vector of the mesh's own space.
vec3 displacement_vector(Object object, DisplacementMap map, vec3 value, vec3 normal)
{
    if (map.channels == 1u) {
        vec3 along = normal;
        if (PLACED) {
            // The mesh's own normal, and where the transform takes it.
            precise vec3 own = vec3(precise_dot(object.to_world[0], normal), precise_dot(object.to_world[1], normal),
                                    precise_dot(object.to_world[2], normal));
            vec3 unit = unit_vector(own);
            vec3 turned = to_world_vector(object, unit);
            along = (object.flags & OBJECT_MIRRORED) != 0u ? -turned : turned;
        }
        precise vec3 result = value.x * along;
        return result;
    }
    return to_world_vector(object, value);
}

precise vec3 displaced(vec3 position, vec3 by)
{
    precise vec3 result = position + by;
    return result;
}

// The normal of the displaced surface where the tangents of the surface and of the map are these: along a and b the map's
// displacement changes by da and db. The change of the direction of displacement is left out: where the displacement does not
// change the normal stays as it is.
vec3 displaced_normal(vec3 a, vec3 b, vec3 da, vec3 db, vec3 normal)
{
    vec3 turned = unit_normal(a + da, b + db);
    return dot(turned, turned) > 0.0 ? turned : normal;
}
#endif
