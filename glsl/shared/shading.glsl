// Colours: the default shading and the debug views. Scene-linear.
#ifndef PLANISH_SHADING
#define PLANISH_SHADING
const uint VIEW_SHADED = 0;
const uint VIEW_NORMAL = 1;
const uint VIEW_PATCH = 2;
const uint VIEW_LEVEL = 3;
const uint VIEW_TESS = 4;
const uint VIEW_UV = 5;
const uint VIEW_COLOR = 6;
const uint VIEW_GREGORY = 7; // patches in the colours of Loop et al. 2009

// Unit directions to the lights.
const vec3 TO_KEY = vec3(0.554, 0.755, 0.352);
const vec3 TO_FILL = vec3(-0.820, 0.256, 0.512);
const vec3 TO_RIM = vec3(-0.251, 0.351, -0.902);

// A lit dielectric. A software driver shades 16 pixels for every tiny triangle, so this is the plain arithmetic that
// shows form: three Lambert terms over a sky and a warm floor, one highlight, and the sky's reflection at grazing angles.
vec3 lit(vec3 normal, vec3 to_eye, vec3 base)
{
    vec3 diffuse = mix(vec3(0.045, 0.035, 0.03), vec3(0.13, 0.15, 0.19), 0.5 + 0.5 * normal.y);
    diffuse += max(dot(normal, TO_KEY), 0.0) * vec3(1.12, 1.03, 0.90);
    diffuse += max(dot(normal, TO_FILL), 0.0) * vec3(0.12, 0.16, 0.24);
    diffuse += max(dot(normal, TO_RIM), 0.0) * vec3(0.34, 0.38, 0.46);
    float facing = dot(normal, to_eye);
    vec3 mirrored = 2.0 * facing * normal - to_eye;
    float glint = max(dot(mirrored, TO_KEY), 0.0);
    glint *= glint;
    glint *= glint;
    glint *= glint;
    glint *= glint; // to the 16th
    float grazing = 1.0 - clamp(facing, 0.0, 1.0);
    grazing *= grazing;
    grazing *= grazing;
    float sky = clamp(mirrored.y + 0.35, 0.0, 1.0);
    return base * diffuse + vec3(0.22 * glint) + grazing * sky * vec3(0.20, 0.24, 0.30);
}

vec3 shade(vec3 normal, vec3 to_eye) { return lit(normal, to_eye, vec3(0.52, 0.47, 0.43)); }

// A colour for a number, neighbours well apart: the golden angle around a circle of hues.
vec3 hue(float turns)
{
    vec3 phase = fract(vec3(turns) + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0));
    return 0.5 + 0.5 * cos(6.2831853 * phase);
}

// A brightness for a patch, neighbours apart.
float varied(uint patch_id)
{
    return 0.7 + 0.6 * fract(float(patch_id % 4096u) * 0.61803399);
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
        // Kind by hue (regular blue, transition red, filling green, semi-sharp crease orange, boundary and infinitely
        // sharp crease cyan), the patch by brightness.
        const vec3 KINDS[8] = vec3[8](vec3(0.12, 0.25, 0.62), vec3(0.65, 0.12, 0.10), vec3(0.15, 0.55, 0.18), vec3(0.40, 0.14, 0.55),
                                      vec3(0.15, 0.55, 0.18), vec3(0.50), vec3(0.80, 0.38, 0.05), vec3(0.06, 0.50, 0.58));
        return lit(normal, to_eye, KINDS[ids.w % 8] * varied(ids.y));
    }
    case VIEW_GREGORY: {
        // Regular gold, also along creases and boundaries; irregular quads purple, triangles green.
        vec3 kind = ids.w == 3u ? vec3(0.34, 0.12, 0.48) : (ids.w == 4u ? vec3(0.15, 0.50, 0.16) : vec3(0.74, 0.50, 0.10));
        return lit(normal, to_eye, kind * varied(ids.y));
    }
    case VIEW_LEVEL:
        return lit(normal, to_eye, level_colour(ids.z));
    case VIEW_TESS:
        return lit(normal, to_eye, 0.7 * hue(0.66 - 0.66 * clamp(log2(factor) / 6.0, 0.0, 1.0)));
    case VIEW_UV:
        return vec3(uv, 0.15);
    default:
        return shade(normal, to_eye);
    }
}
#endif
