// What a surface does with light: GGX over Lambert, under a clear coat.
// D: Walter et al. 2007. V: Smith, height-correlated (Heitz 2014), over 4 cos cos. F: Schlick 1994.
// Energy that single scattering loses comes back as a multiple of it (Turquin 2019, Practical multiple scattering compensation for
// microfacet models), by the albedo at F = 1; what the specular lobe reflects is not there for the diffuse one.
// CPU twin of the albedo: crates/render/src/shading/albedo_table.rs.
#ifndef PLANISH_BRDF
#define PLANISH_BRDF
#include "shade_frame.glsl"

const float PI = 3.14159265;
// Entries along a side of the table of albedos: cosine by columns, roughness by rows.
const uint ALBEDO_SIZE = 32;
// Least roughness under lights without extent: smaller highlights would be missed by any number of samples.
const float LEAST_ROUGHNESS = 0.07;

struct Surface {
    vec3 normal;      // with the normal map
    vec3 coat_normal; // without
    vec3 to_eye;
    vec3 diffuse;     // albedo
    vec3 f0;
    float f90;
    float roughness;
    float coat;
    float coat_roughness;
    float occlusion;
    vec3 emissive;
    // Of these: the share that the specular lobe and the coat reflect, and what multiple scattering adds.
    vec3 specular_albedo;
    vec3 compensation;
    float coat_albedo;
};

// Scale and bias of the reflectance at normal incidence: the albedo of GGX (Karis 2013, split sum).
vec2 ggx_albedo(Floats table, float cosine, float roughness)
{
    vec2 at = clamp(vec2(cosine, roughness), 0.0, 1.0) * float(ALBEDO_SIZE - 1u);
    uvec2 cell = min(uvec2(at), uvec2(ALBEDO_SIZE - 2u));
    vec2 t = at - vec2(cell);
    vec2 result = vec2(0.0);
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        uvec2 corner = uvec2(i & 1u, i >> 1);
        vec2 weight = mix(1.0 - t, t, vec2(corner));
        uint entry = 2u * ((cell.y + corner.y) * ALBEDO_SIZE + cell.x + corner.x);
        result += weight.x * weight.y * vec2(table.v[entry], table.v[entry + 1u]);
    }
    return result;
}

// Finds what follows from the other members.
void finish_surface(Floats table, inout Surface surface)
{
    float cosine = clamp(dot(surface.normal, surface.to_eye), 1e-4, 1.0);
    vec2 albedo = ggx_albedo(table, cosine, surface.roughness);
    surface.compensation = 1.0 + surface.f0 * (1.0 / max(albedo.x + albedo.y, 1e-3) - 1.0);
    surface.specular_albedo = min((surface.f0 * albedo.x + surface.f90 * albedo.y) * surface.compensation, 1.0);
    vec2 coat = ggx_albedo(table, clamp(dot(surface.coat_normal, surface.to_eye), 1e-4, 1.0), surface.coat_roughness);
    surface.coat_albedo = surface.coat * (0.04 * coat.x + coat.y);
}

float pow5(float x)
{
    float square = x * x;
    return square * square * x;
}

// D times V.
float ggx(float alpha, float n_h, float n_v, float n_l)
{
    float square = alpha * alpha;
    float d = (n_h * square - n_h) * n_h + 1.0;
    float v = n_l * sqrt((n_v - square * n_v) * n_v + square) + n_v * sqrt((n_l - square * n_l) * n_l + square);
    return square / (PI * d * d) * (0.5 / max(v, 1e-7));
}

float lobe(vec3 normal, vec3 to_eye, vec3 to_light, vec3 middle, float roughness)
{
    float r = max(roughness, LEAST_ROUGHNESS);
    float n_v = max(dot(normal, to_eye), 1e-4);
    float n_l = dot(normal, to_light);
    return n_l > 0.0 ? n_l * ggx(r * r, clamp(dot(normal, middle), 0.0, 1.0), n_v, n_l) : 0.0;
}

// Radiance to the eye of light from one direction that gives a surface across it an irradiance of 1.
vec3 lit_surface(Surface surface, vec3 to_light)
{
    vec3 middle = normalize(to_light + surface.to_eye);
    float schlick = pow5(1.0 - clamp(dot(middle, surface.to_eye), 0.0, 1.0));
    vec3 fresnel = surface.f0 + (surface.f90 - surface.f0) * schlick;
    float n_l = max(dot(surface.normal, to_light), 0.0);
    vec3 result = (1.0 - surface.specular_albedo) * surface.diffuse * (n_l / PI);
    result += lobe(surface.normal, surface.to_eye, to_light, middle, surface.roughness) * fresnel * surface.compensation;
    float coat = lobe(surface.coat_normal, surface.to_eye, to_light, middle, surface.coat_roughness);
    return result * (1.0 - surface.coat_albedo) + surface.coat * coat * (0.04 + 0.96 * schlick);
}
#endif
