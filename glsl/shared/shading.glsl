// Colours: the default shading and the debug views. Scene-linear.
#ifndef PLANISH_SHADING
#define PLANISH_SHADING
const uint VIEW_SHADED = 0;
const uint VIEW_NORMAL = 1;
const uint VIEW_PATCH = 2;
const uint VIEW_LEVEL = 3;
const uint VIEW_TESS = 4;
const uint VIEW_UV = 5;

// Radiance of the surroundings along a direction: a soft sky over a warm floor.
vec3 sky(vec3 direction)
{
    float height = direction.y;
    vec3 horizon = vec3(0.62, 0.64, 0.66);
    vec3 colour = mix(horizon, vec3(0.30, 0.42, 0.62), smoothstep(0.0, 0.9, height));
    return mix(colour, vec3(0.20, 0.16, 0.13), smoothstep(0.0, -0.35, height));
}

// One light: Lambert and a GGX lobe of the given roughness.
vec3 light(vec3 normal, vec3 to_eye, vec3 to_light, vec3 radiance, vec3 base, float roughness)
{
    float n_l = max(dot(normal, to_light), 0.0);
    float n_v = max(dot(normal, to_eye), 1e-3);
    vec3 middle = normalize(to_light + to_eye);
    float n_h = max(dot(normal, middle), 0.0);
    float alpha = roughness * roughness;
    float denominator = n_h * n_h * (alpha * alpha - 1.0) + 1.0;
    float distribution = alpha * alpha / (3.14159265 * denominator * denominator);
    float shadowing = 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, alpha);
    float fresnel = 0.04 + 0.96 * pow(1.0 - max(dot(to_eye, middle), 0.0), 5.0);
    return radiance * n_l * (base / 3.14159265 + distribution * shadowing * fresnel);
}

vec3 lit(vec3 normal, vec3 to_eye, vec3 base, float roughness)
{
    vec3 colour = light(normal, to_eye, normalize(vec3(0.55, 0.75, 0.35)), vec3(3.0, 2.8, 2.5), base, roughness);
    colour += light(normal, to_eye, normalize(vec3(-0.8, 0.25, 0.5)), vec3(0.45, 0.55, 0.7), base, roughness);
    colour += light(normal, to_eye, normalize(vec3(-0.25, 0.35, -0.9)), vec3(1.1, 1.15, 1.3), base, roughness);
    // Ambient: the sky averaged around the normal, and its reflection, stronger at grazing angles.
    vec3 ambient = mix(vec3(0.16, 0.13, 0.11), vec3(0.42, 0.47, 0.54), 0.5 + 0.5 * normal.y);
    float grazing = pow(1.0 - max(dot(normal, to_eye), 0.0), 5.0);
    colour += base * ambient * 0.55 + sky(reflect(-to_eye, normal)) * (0.04 + 0.5 * grazing) * (1.0 - roughness);
    return colour;
}

vec3 shade(vec3 normal, vec3 to_eye) { return lit(normal, to_eye, vec3(0.58, 0.55, 0.52), 0.42); }

// A colour for a number, neighbours well apart: the golden angle around a circle of hues.
vec3 hue(float turns)
{
    vec3 phase = fract(vec3(turns) + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0));
    return 0.5 + 0.5 * cos(6.2831853 * phase);
}

vec3 level_colour(uint level)
{
    const vec3 COLOURS[6] = vec3[6](vec3(0.10, 0.25, 0.70), vec3(0.08, 0.55, 0.22), vec3(0.80, 0.55, 0.05),
                                    vec3(0.70, 0.10, 0.08), vec3(0.42, 0.12, 0.60), vec3(0.05, 0.50, 0.55));
    return COLOURS[level % 6];
}

vec3 view_color(uint view, vec3 normal, vec3 to_eye, vec2 uv, uvec4 ids, float factor)
{
    switch (view) {
    case VIEW_NORMAL:
        return pow(0.5 + 0.5 * normal, vec3(2.2));
    case VIEW_PATCH: {
        // Kind by hue (regular blue, transition red, filling green), the patch by brightness.
        const vec3 KINDS[3] = vec3[3](vec3(0.12, 0.25, 0.62), vec3(0.65, 0.12, 0.10), vec3(0.15, 0.55, 0.18));
        float vary = 0.7 + 0.6 * fract(float(ids.y % 4096u) * 0.61803399);
        return lit(normal, to_eye, KINDS[ids.w % 3] * vary, 0.6);
    }
    case VIEW_LEVEL:
        return lit(normal, to_eye, level_colour(ids.z), 0.6);
    case VIEW_TESS:
        return lit(normal, to_eye, 0.7 * hue(0.66 - 0.66 * clamp(log2(factor) / 6.0, 0.0, 1.0)), 0.6);
    case VIEW_UV:
        return vec3(uv, 0.15);
    default:
        return shade(normal, to_eye);
    }
}
#endif
