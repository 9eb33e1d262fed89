// Light from all around: an image in latitude and longitude, and what rough surfaces reflect of it (environment.rs).
#ifndef PLANISH_ENVIRONMENT
#define PLANISH_ENVIRONMENT
#include "brdf.glsl"
#include "textures.glsl"

// Where a direction lies in the image: its middle is -z, its left quarter -x, its upper edge +y.
vec2 lat_long(Environment environment, vec3 direction)
{
    vec3 own = vec3(dot(environment.to_own[0], direction), dot(environment.to_own[1], direction),
                    dot(environment.to_own[2], direction));
    float s = atan(own.x, -own.z) / (2.0 * PI) + 0.5;
    return vec2(s, acos(clamp(own.y * inversesqrt(max(dot(own, own), 1e-20)), -1.0, 1.0)) / PI);
}

// The image itself, in pixels of this angle.
vec3 environment_mirror(MaterialScene scene, Environment environment, vec3 direction, float angle)
{
    float lod = log2(max(angle * float(scene.v.textures.v[environment.first_texture].width) / (2.0 * PI), 1e-3));
    return sample_lod(scene, environment.first_texture, lat_long(environment, direction), lod).rgb;
}

// The image as a surface of some roughness reflects it.
vec3 environment_rough(MaterialScene scene, Environment environment, vec3 direction, float roughness, float angle)
{
    float at = clamp(roughness, 0.0, 1.0) * float(environment.texture_count - 1u);
    uint level = min(uint(at), environment.texture_count - 2u);
    float t = at - float(level);
    vec2 st = lat_long(environment, direction);
    vec3 result = vec3(0.0);
    if (level == 0u && t < 1.0) {
        result = (1.0 - t) * environment_mirror(scene, environment, direction, angle);
    }
    [[dont_unroll]] for (uint i = level == 0u ? 1u : 0u; i < 2u; ++i) {
        result += (i == 0u ? 1.0 - t : t) * sample_level(scene, environment.first_texture + level + i, st, 0u).rgb;
    }
    return result;
}

// Radiance to the eye of all that comes from the environment.
vec3 lit_by_environment(MaterialScene scene, Environment environment, Surface surface, float angle)
{
    vec3 diffuse = sample_level(scene, environment.irradiance, lat_long(environment, surface.normal), 0u).rgb;
    vec3 mirrored = reflect(-surface.to_eye, surface.normal);
    vec3 specular = environment_rough(scene, environment, mirrored, surface.roughness, angle);
    vec3 result = (1.0 - surface.specular_albedo) * surface.diffuse * diffuse + surface.specular_albedo * specular;
    if (surface.coat > 0.0) {
        mirrored = reflect(-surface.to_eye, surface.coat_normal);
        vec3 coat = environment_rough(scene, environment, mirrored, surface.coat_roughness, angle);
        result = result * (1.0 - surface.coat_albedo) + surface.coat_albedo * coat;
    }
    return result * surface.occlusion * environment.color;
}
#endif
