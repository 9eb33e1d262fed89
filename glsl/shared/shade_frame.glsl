// What shading a frame needs: where the G-buffer is, how it was seen, what lights it, and where its light adds up.
// Filled by crates/render/src/shading/.
#ifndef PLANISH_SHADE_FRAME
#define PLANISH_SHADE_FRAME
#include "materials.glsl"
#include "pixels.glsl"

const uint LIGHT_DISTANT = 0;
const uint LIGHT_POINT = 1;
const uint LIGHT_SPOT = 2;
const uint NO_SHADOW = 0xffffffffu;

struct Light {
    vec3 position;        // of a distant light the direction to it
    uint kind;
    vec3 intensity;       // radiant; of a distant light irradiance across its direction
    float inverse_range;  // 0 without a range
    vec3 axis;            // where a spot shines
    float cone_scale;     // its falloff, by the cosine of the angle to the axis (KHR_lights_punctual)
    float cone_offset;
    uint first_view;      // of its shadow maps, or NO_SHADOW
    uint view_count;      // 1, or 6: along +x -x +y -y +z -z
};

// A shadow map: depth as a camera at the light has it, near over depth.
struct ShadowView {
    mat4 world_to_clip;
    float near;
    float texel;      // width at depth 1, in world units
    uint first_depth; // in the depths of all maps
    uint size;        // texels a side
};

// An environment: its image and what rough surfaces reflect of it are textures in latitude and longitude.
struct Environment {
    vec3 color;
    uint first_texture;  // mirrors first, the roughest last
    vec3 to_own[3];      // world to its own space: rows
    uint texture_count;
    uint irradiance;     // texture: means over the cosine
    uint is_there;
    uint is_visible;
    uint padding;
};

// How much of ids a pixel holds.
struct IdWeight {
    uint id;
    uint count; // samples; 0 where there is none
};
const uint ID_SLOTS = 8;

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer UVec4s { uvec4 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Lights { Light v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ShadowViews { ShadowView v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer IdWeights { IdWeight v[]; };

struct ShadeFrame {
    MaterialScene scene;
    HalfVec4s colors;       // the G-buffer
    Vec4s normals;
    UVec4s objects;
    HalfVec4s footprints;
    Vec4s sum;              // of radiance and coverage
    IdWeights object_ids;   // ID_SLOTS a pixel
    IdWeights material_ids;
    Floats albedo;          // of GGX: scale and bias of the reflectance (albedo_table.rs)
    Lights lights;
    ShadowViews views;
    Floats depths;
    vec3 eye;
    uint width;
    vec3 first_ray;         // at depth 1, through the upper left corner of the image
    uint height;
    vec3 ray_dx;            // its change from pixel to pixel, and from line to line
    uint light_count;
    vec3 ray_dy;
    uint has_ids;
    Environment environment;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ShadeFrames { ShadeFrame v; };
#endif
