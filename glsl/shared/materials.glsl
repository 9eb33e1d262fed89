// Materials and textures of a scene, reached through one address, and which material a place of an object has.
// Filled by crates/render/src/shading/.
#ifndef PLANISH_MATERIALS
#define PLANISH_MATERIALS
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

const uint NO_TEXTURE = 0xffffffffu;
const uint NO_MATERIAL = 0xffffffffu;
const uint MAX_TEXTURE_LEVELS = 16;

const uint TEXTURE_HALF = 1;    // four halves a texel, linear; else four bytes
const uint TEXTURE_SRGB = 2;    // the first three of the bytes are sRGB
const uint TEXTURE_NEAREST = 4; // not filtered
const uint WRAP_REPEAT = 0;
const uint WRAP_MIRROR = 1;
const uint WRAP_CLAMP = 2;
const uint WRAP_BLACK = 3;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats { float v[]; };

// An image and its mipmaps, finest first, rows from the top.
struct Texture {
    Words texels;
    uint width;
    uint height;
    uint level_count;
    uint flags;
    uint wrap_s;
    uint wrap_t;
    uint first_word[MAX_TEXTURE_LEVELS]; // of each level
};

// A texture as a material uses it.
struct TextureUse {
    uint texture;
    uint channel; // of scalars
    vec3 to_s;    // texture coordinates (s, t, 1) to those of the image
    vec3 to_t;
    vec4 scale;
    vec4 bias;
};

const uint USE_BASE_COLOR = 0;
const uint USE_OPACITY = 1;
const uint USE_METALLIC = 2;
const uint USE_ROUGHNESS = 3;
const uint USE_NORMAL = 4;
const uint USE_OCCLUSION = 5;
const uint USE_EMISSIVE = 6;
const uint USE_COUNT = 7;

const uint MATERIAL_MASK = 1;     // nothing where the opacity is below the threshold
const uint MATERIAL_BLEND = 2;    // a share of the samples hits the surface
const uint MATERIAL_SPECULAR = 4; // reflects `specular` at normal incidence
const uint MATERIAL_SINGLE_SIDED = 8; // its back is not there

struct Material {
    vec3 base_color;
    float opacity;
    vec3 emissive;
    float threshold;
    vec3 specular;
    float reflectance; // of a dielectric at normal incidence
    float metallic;
    float roughness;
    float clearcoat;
    float clearcoat_roughness;
    float occlusion_strength;
    uint flags;
    uint id; // told by coverage
    TextureUse uses[USE_COUNT];
};

// An object's materials, and what it is told by.
struct ShadedObject {
    uint first_face;     // number of its first Ptex face among those of all objects
    uint first_slot;     // of the materials of its slots
    uint slot_count;
    uint first_face_slot; // in the slots of Ptex faces; NO_TEXTURE where all are of the first slot
    uint id;
};

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Textures { Texture v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Materials { Material v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ShadedObjects { ShadedObject v[]; };

struct MaterialTables {
    Materials materials;
    Textures textures;
    ShadedObjects objects;
    Words face_slots;
    Words slot_materials;
    Floats srgb; // the 256 values of a byte, decoded
    uint has_studio; // without a material surfaces are shaded as they are without a scene's light
    uint sample_index;
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer MaterialScene { MaterialTables v; };

// The material at a Ptex face of an object, or NO_MATERIAL.
uint material_at(MaterialScene scene, uint object_index, uint face)
{
    ShadedObject object = scene.v.objects.v[object_index];
    uint slot = 0u;
    if (object.first_face_slot != NO_TEXTURE) {
        slot = scene.v.face_slots.v[object.first_face_slot + face - object.first_face];
    }
    return slot < object.slot_count ? scene.v.slot_materials.v[object.first_slot + slot] : NO_MATERIAL;
}

// A number of [0, 1) that looks random, the same for the same place: pcg3d (Jarzynski and Olano 2020, Hash Functions for GPU Rendering).
float hashed(uvec3 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return float(v.z >> 8u) * (1.0 / 16777216.0);
}
#endif
