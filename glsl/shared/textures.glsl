// Textures, filtered by hand as displacement maps are: no descriptors, no limit on their number, the same on every device.
// CPU twin: crates/render/src/shading/filter.rs.
//
// Textures and materials are handed on by their place, and read member by member: a copy of a structure that holds an array lies in
// memory, once a thread.
#ifndef PLANISH_TEXTURES
#define PLANISH_TEXTURES
#include "materials.glsl"

// Most places along the longer axis of a pixel's footprint that are looked at.
const float MAX_PROBES = 8.0;

vec4 texel_of(MaterialScene scene, uint texture, uint flags, uint word_at)
{
    Words texels = scene.v.textures.v[texture].texels;
    if ((flags & TEXTURE_HALF) != 0u) {
        return vec4(unpackHalf2x16(texels.v[word_at]), unpackHalf2x16(texels.v[word_at + 1u]));
    }
    uint word = texels.v[word_at];
    if ((flags & TEXTURE_SRGB) != 0u) {
        return vec4(scene.v.srgb.v[word & 0xffu], scene.v.srgb.v[word >> 8 & 0xffu], scene.v.srgb.v[word >> 16 & 0xffu],
                    float(word >> 24) / 255.0);
    }
    return unpackUnorm4x8(word);
}

// A texel's column or row within the image, or -1 for none.
int wrapped(int at, int size, uint wrap)
{
    switch (wrap) {
    case WRAP_REPEAT:
        at %= size;
        return at < 0 ? at + size : at;
    case WRAP_MIRROR:
        at %= 2 * size;
        at = at < 0 ? at + 2 * size : at;
        return at < size ? at : 2 * size - 1 - at;
    case WRAP_CLAMP:
        return clamp(at, 0, size - 1);
    default:
        return at < 0 || at >= size ? -1 : at;
    }
}

vec4 texel_at(MaterialScene scene, uint texture, uint flags, uint first_word, ivec2 size, ivec2 at)
{
    at = ivec2(wrapped(at.x, size.x, scene.v.textures.v[texture].wrap_s), wrapped(at.y, size.y, scene.v.textures.v[texture].wrap_t));
    if (min(at.x, at.y) < 0) {
        return vec4(0.0);
    }
    uint words = (flags & TEXTURE_HALF) != 0u ? 2u : 1u;
    return texel_of(scene, texture, flags, first_word + words * uint(at.y * size.x + at.x));
}

vec4 sample_level(MaterialScene scene, uint texture, vec2 st, uint level)
{
    uint flags = scene.v.textures.v[texture].flags;
    uint first_word = scene.v.textures.v[texture].first_word[level];
    ivec2 size = max(ivec2(scene.v.textures.v[texture].width, scene.v.textures.v[texture].height) >> int(level), ivec2(1));
    // Coordinates that are out of all bounds are no places.
    vec2 at = clamp(st, -1e6, 1e6) * vec2(size);
    if ((flags & TEXTURE_NEAREST) != 0u) {
        return texel_at(scene, texture, flags, first_word, size, ivec2(floor(at)));
    }
    vec2 cell = floor(at - 0.5);
    vec2 t = at - 0.5 - cell;
    vec4 result = vec4(0.0);
    [[dont_unroll]] for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 weight = mix(1.0 - t, t, vec2(corner));
        result += weight.x * weight.y * texel_at(scene, texture, flags, first_word, size, ivec2(cell) + corner);
    }
    return result;
}

// Between two levels of detail; `lod` 0 is the finest.
vec4 sample_lod(MaterialScene scene, uint texture, vec2 st, float lod)
{
    bool is_nearest = (scene.v.textures.v[texture].flags & TEXTURE_NEAREST) != 0u;
    lod = clamp(lod, 0.0, float(scene.v.textures.v[texture].level_count - 1u));
    uint level = uint(is_nearest ? lod + 0.5 : lod);
    float t = is_nearest ? 0.0 : lod - float(level);
    vec4 result = vec4(0.0);
    [[dont_unroll]] for (uint i = 0u; i < 2u && (i == 0u || t > 0.0); ++i) {
        result += (i == 0u ? 1.0 - t : t) * sample_level(scene, texture, st, level + i);
    }
    return result;
}

// The mean over a pixel: `footprint` is how st changes to the next pixel and to the next line. Where the footprint is long, at grazing
// angles, several places along it are looked at, each as finely as it is wide.
vec4 sample_texture(MaterialScene scene, uint texture, vec2 st, vec4 footprint)
{
    vec2 size = vec2(scene.v.textures.v[texture].width, scene.v.textures.v[texture].height);
    vec2 x = footprint.xy * size;
    vec2 y = footprint.zw * size;
    float along_x = dot(x, x);
    float along_y = dot(y, y);
    vec2 axis = along_x > along_y ? footprint.xy : footprint.zw;
    float longest = sqrt(max(along_x, along_y));
    // What is across the longer axis: area over length.
    float shortest = longest > 0.0 ? abs(x.x * y.y - x.y * y.x) / longest : 0.0;
    float probes = clamp(ceil(longest / max(shortest, 1.0)), 1.0, MAX_PROBES);
    float lod = log2(max(longest / probes, 1e-6));
    vec4 result = vec4(0.0);
    [[dont_unroll]] for (float i = 0.5; i < probes; i += 1.0) {
        result += sample_lod(scene, texture, st + (i / probes - 0.5) * axis, lod);
    }
    return result / probes;
}

// What a material's texture says at a place; 1 without one.
vec4 texture_value(MaterialScene scene, TextureUse use, vec2 st, vec4 footprint)
{
    if (use.texture == NO_TEXTURE) {
        return vec4(1.0);
    }
    vec2 at = vec2(dot(use.to_s, vec3(st, 1.0)), dot(use.to_t, vec3(st, 1.0)));
    vec4 change = vec4(dot(use.to_s.xy, footprint.xy), dot(use.to_t.xy, footprint.xy), dot(use.to_s.xy, footprint.zw),
                       dot(use.to_t.xy, footprint.zw));
    return sample_texture(scene, use.texture, at, change) * use.scale + use.bias;
}

float texture_scalar(MaterialScene scene, TextureUse use, vec2 st, vec4 footprint)
{
    return texture_value(scene, use, st, footprint)[use.channel & 3u];
}

// Whether a sample meets no surface at a place of a material: masked, or the share that passes.
bool passes(MaterialScene scene, uint material, uint object, bool is_back, uvec2 pixel, vec2 st, vec4 footprint)
{
    if (material == NO_MATERIAL) {
        return false;
    }
    uint flags = scene.v.materials.v[material].flags;
    if ((flags & MATERIAL_SINGLE_SIDED) != 0u && is_back) {
        return true;
    }
    if ((flags & (MATERIAL_MASK | MATERIAL_BLEND)) == 0u) {
        return false;
    }
    float opacity = scene.v.materials.v[material].opacity;
    opacity *= texture_scalar(scene, scene.v.materials.v[material].uses[USE_OPACITY], st, footprint);
    if ((flags & MATERIAL_MASK) != 0u) {
        return opacity < scene.v.materials.v[material].threshold;
    }
    return opacity <= hashed(uvec3(pixel.x | pixel.y << 16, scene.v.sample_index, object));
}
#endif
