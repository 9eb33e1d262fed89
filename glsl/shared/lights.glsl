// Light from distant, point and spot lights (KHR_lights_punctual), and their shadows.
#ifndef PLANISH_LIGHTS
#define PLANISH_LIGHTS
#include "shade_frame.glsl"

// Texels from the middle of a shadow's filter to its edge: a box of 3 x 3 texels, cut bilinearly.
const int SHADOW_RADIUS = 1;

// What a light gives a surface that faces it, and where it is.
struct Lighting {
    vec3 to_light;
    vec3 irradiance;
};

Lighting light_at(Light light, vec3 point)
{
    if (light.kind == LIGHT_DISTANT) {
        return Lighting(light.position, light.intensity);
    }
    vec3 way = light.position - point;
    float square = max(dot(way, way), 1e-12);
    vec3 to_light = way * inversesqrt(square);
    float reach = square * light.inverse_range * light.inverse_range;
    float attenuation = clamp(1.0 - reach * reach, 0.0, 1.0) / square;
    if (light.kind == LIGHT_SPOT) {
        float cone = clamp(dot(-to_light, light.axis) * light.cone_scale + light.cone_offset, 0.0, 1.0);
        attenuation *= cone * cone;
    }
    return Lighting(to_light, light.intensity * attenuation);
}

// Whether light passes the texel at a depth; beyond the map it does.
float passes_texel(ShadowView view, Floats depths, ivec2 texel, float depth)
{
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(view.size)))) {
        return 1.0;
    }
    float nearest = depths.v[view.first_depth + uint(texel.y) * view.size + uint(texel.x)];
    return nearest * depth <= view.near ? 1.0 : 0.0;
}

// The share of a light that reaches a point with this normal.
float lit_share(Light light, ShadowViews views, Floats depths, vec3 point, vec3 normal, vec3 to_light)
{
    if (light.first_view == NO_SHADOW) {
        return 1.0;
    }
    uint face = 0u;
    if (light.view_count == 6u) {
        vec3 way = -to_light;
        vec3 size = abs(way);
        uint axis = size.x >= max(size.y, size.z) ? 0u : (size.y >= size.z ? 1u : 2u);
        face = 2u * axis + (way[axis] < 0.0 ? 1u : 0u);
    }
    ShadowView view = views.v[light.first_view + face];
    // A texel is a square across the light's direction, in which the surface is as deep as its slope; and the filter looks at others
    // around. The point moves out along its normal by as much of that as it takes, and a little to the light for what tessellation
    // differs by between the light's view and the eye's.
    float texel = (view.world_to_clip * vec4(point, 1.0)).w * view.texel;
    float cosine = clamp(dot(normal, to_light), 0.0, 1.0);
    float sine = sqrt(1.0 - cosine * cosine);
    vec3 moved = point + normal * (texel * sine * (float(SHADOW_RADIUS) + 1.0) * 1.41421) + to_light * (0.5 * texel);
    vec4 clip = view.world_to_clip * vec4(moved, 1.0);
    if (clip.w <= view.near) {
        return 1.0;
    }
    vec2 at = (vec2(0.5, -0.5) * clip.xy / clip.w + 0.5) * float(view.size) - 0.5;
    ivec2 cell = ivec2(floor(at));
    vec2 t = at - vec2(cell);
    float sum = 0.0;
    const int SIDE = 2 * SHADOW_RADIUS + 2;
    [[dont_unroll]] for (int i = 0; i < SIDE * SIDE; ++i) {
        ivec2 offset = ivec2(i % SIDE, i / SIDE) - SHADOW_RADIUS;
        vec2 weight = vec2(offset.x == -SHADOW_RADIUS ? 1.0 - t.x : (offset.x == SHADOW_RADIUS + 1 ? t.x : 1.0),
                           offset.y == -SHADOW_RADIUS ? 1.0 - t.y : (offset.y == SHADOW_RADIUS + 1 ? t.y : 1.0));
        sum += weight.x * weight.y * passes_texel(view, depths, cell + offset, clip.w);
    }
    return sum / float((SIDE - 1) * (SIDE - 1));
}
#endif
