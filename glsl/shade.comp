#version 460
// Shades a sample of every pixel from its G-buffer, and adds it to the frame's sum: one thread, one pixel.
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"
#include "shared/gbuffer.glsl"
#include "shared/shading.glsl"
#include "shared/lights.glsl"
#include "shared/environment.glsl"

layout(push_constant, scalar) uniform ShadePush { ShadeFrames frame; } push;

// What the G-buffer says of a pixel.
struct Sample {
    vec3 point;
    vec3 normal;
    vec3 to_eye;
    vec3 tangent;
    vec3 bitangent;
    vec3 color;
    vec2 st;
    vec4 footprint;
    uint object;
    uint material;
    bool is_back;
};

Sample read_sample(ShadeFrames frame, uint pixel, vec3 ray, vec4 normal_depth)
{
    uvec4 ids = frame.v.objects.v[pixel];
    uvec2 color = frame.v.colors.v[pixel];
    uvec2 footprint = frame.v.footprints.v[pixel];
    Sample result;
    result.point = frame.v.eye + normal_depth.w * ray;
    result.normal = from_octahedral(normal_depth.xy);
    result.to_eye = normalize(-ray);
    vec3 x;
    vec3 y;
    across(result.normal, x, y);
    vec2 turn = from_turn(normal_depth.z);
    result.tangent = turn.x * x + turn.y * y;
    result.bitangent = cross(result.normal, result.tangent) * ((ids.x & GBUFFER_TURNED) != 0u ? -1.0 : 1.0);
    result.color = vec3(unpackHalf2x16(color.x), unpackHalf2x16(color.y).x);
    result.st = uintBitsToFloat(ids.zw);
    result.footprint = vec4(unpackHalf2x16(footprint.x), unpackHalf2x16(footprint.y));
    result.object = ids.x & GBUFFER_OBJECT;
    result.material = material_at(frame.v.scene, result.object, ids.y);
    result.is_back = (ids.x & GBUFFER_BACK) != 0u;
    return result;
}

// The normal with the normal map: x to the right in the image, y up, z out of it. From behind it is what is seen from there.
vec3 mapped_normal(MaterialScene scene, Sample at, vec3 n)
{
    TextureUse use = scene.v.materials.v[at.material].uses[USE_NORMAL];
    if (use.texture == NO_TEXTURE) {
        return at.normal;
    }
    // Where the image's axes run on the surface: columns of the inverse of its transform.
    float side = use.to_s.x * use.to_t.y - use.to_s.y * use.to_t.x < 0.0 ? -1.0 : 1.0;
    vec3 right = side * (use.to_t.y * at.tangent - use.to_t.x * at.bitangent);
    vec3 down = side * (use.to_s.x * at.bitangent - use.to_s.y * at.tangent);
    vec3 aside = n.x * right * inversesqrt(max(dot(right, right), 1e-20)) - n.y * down * inversesqrt(max(dot(down, down), 1e-20));
    vec3 turned = (at.is_back ? -aside : aside) + n.z * at.normal;
    return turned * inversesqrt(max(dot(turned, turned), 1e-20));
}

Surface read_surface(ShadeFrames frame, Sample at)
{
    MaterialScene scene = frame.v.scene;
    Materials materials = scene.v.materials;
    uint m = at.material;
    vec4 values[USE_COUNT];
    [[dont_unroll]] for (uint i = 0u; i < USE_COUNT; ++i) {
        values[i] = texture_value(scene, scene.v.materials.v[at.material].uses[i], at.st, at.footprint);
    }
    Surface result;
    result.coat_normal = at.normal;
    result.normal = mapped_normal(scene, at, values[USE_NORMAL].xyz);
    result.to_eye = at.to_eye;
    vec3 base = max(materials.v[m].base_color * values[USE_BASE_COLOR].rgb * at.color, 0.0);
    float metallic = clamp(materials.v[m].metallic * values[USE_METALLIC][materials.v[m].uses[USE_METALLIC].channel & 3u], 0.0, 1.0);
    result.roughness = clamp(materials.v[m].roughness * values[USE_ROUGHNESS][materials.v[m].uses[USE_ROUGHNESS].channel & 3u], 0.0, 1.0);
    bool has_specular = (materials.v[m].flags & MATERIAL_SPECULAR) != 0u;
    result.diffuse = has_specular ? base : base * (1.0 - metallic);
    result.f0 = has_specular ? materials.v[m].specular : mix(vec3(materials.v[m].reflectance), base, metallic);
    // What reflects less than 2 % is shadow rather than matter (Lagarde and de Rousiers 2014).
    result.f90 = clamp(50.0 * max(result.f0.r, max(result.f0.g, result.f0.b)), 0.0, 1.0);
    result.coat = materials.v[m].clearcoat;
    result.coat_roughness = materials.v[m].clearcoat_roughness;
    float occlusion = values[USE_OCCLUSION][materials.v[m].uses[USE_OCCLUSION].channel & 3u];
    result.occlusion = clamp(1.0 + materials.v[m].occlusion_strength * (occlusion - 1.0), 0.0, 1.0);
    result.emissive = materials.v[m].emissive * values[USE_EMISSIVE].rgb;
    finish_surface(frame.v.albedo, result);
    return result;
}

vec3 radiance(ShadeFrames frame, Sample at)
{
    if (at.material == NO_MATERIAL) {
        return shade(at.normal, at.to_eye);
    }
    Surface surface = read_surface(frame, at);
    vec3 result = surface.emissive * (1.0 - surface.coat_albedo);
    for (uint i = 0u; i < frame.v.light_count; ++i) {
        Light light = frame.v.lights.v[i];
        Lighting lighting = light_at(light, at.point);
        bool reaches = dot(at.normal, lighting.to_light) > 0.0 && lighting.irradiance != vec3(0.0);
        float share = reaches ? lit_share(light, frame.v.views, frame.v.depths, at.point, at.normal, lighting.to_light) : 0.0;
        if (share > 0.0) {
            result += share * lighting.irradiance * lit_surface(surface, lighting.to_light);
        }
    }
    if (frame.v.environment.is_there != 0u) {
        result += lit_by_environment(frame.v.scene, frame.v.environment, surface, length(frame.v.ray_dx));
    }
    return result;
}

// Counts a sample of an id. Of more ids than there are slots the last ones are left out.
void count_id(IdWeights weights, uint pixel, uint id)
{
    for (uint slot = ID_SLOTS * pixel; slot < ID_SLOTS * (pixel + 1u); ++slot) {
        uint count = weights.v[slot].count;
        if (count == 0u || weights.v[slot].id == id) {
            weights.v[slot] = IdWeight(id, count + 1u);
            return;
        }
    }
}

void main()
{
    ShadeFrames frame = push.frame;
    uint pixel = thread_index();
    if (pixel >= frame.v.width * frame.v.height) {
        return;
    }
    vec2 at = vec2(pixel % frame.v.width, pixel / frame.v.width) + 0.5;
    vec3 ray = frame.v.first_ray + at.x * frame.v.ray_dx + at.y * frame.v.ray_dy;
    vec4 normal_depth = frame.v.normals.v[pixel];
    vec4 result = vec4(0.0);
    if (normal_depth.w > 0.0) {
        Sample read = read_sample(frame, pixel, ray, normal_depth);
        vec3 light = radiance(frame, read);
        // A pixel that is no number would spoil all that is made of the image.
        result = vec4(any(isnan(light)) || any(isinf(light)) ? vec3(0.0) : max(light, 0.0), 1.0);
        if (frame.v.has_ids != 0u) {
            count_id(frame.v.object_ids, pixel, frame.v.scene.v.objects.v[read.object].id);
            bool has_material = read.material != NO_MATERIAL;
            count_id(frame.v.material_ids, pixel, has_material ? frame.v.scene.v.materials.v[read.material].id : 0u);
        }
    } else if (frame.v.environment.is_there != 0u && frame.v.environment.is_visible != 0u) {
        vec3 light = environment_mirror(frame.v.scene, frame.v.environment, ray, length(frame.v.ray_dx));
        // Seen, it covers: an image file without coverage shows nothing there.
        result = vec4(light * frame.v.environment.color, 1.0);
    }
    frame.v.sum.v[pixel] += result;
}
