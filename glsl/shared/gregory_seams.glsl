// What a patch of an irregular face shares with its neighbours: where a bicubic patch lies across an edge it decides, at corners the
// limit points do. Included where `patch_places` and `push` are declared.
#ifndef PLANISH_GREGORY_SEAMS
#define PLANISH_GREGORY_SEAMS
#include "border.glsl"

struct Evaluated {
    vec3 position;
    vec3 along_u; // tangents; of a triangle towards corner 0 and corner 1, away from corner 2
    vec3 along_v;
};

// On which of the edges that the patch shares a point lies, if it lies on edges.
struct Seam {
    uint edge;       // of the shared curves, NONE for none
    Parameter at;    // on it
    uint of_face;    // number of the edge among those of the face
    bool is_outer;   // an edge of the face, and not one inside, between its parts
    bool is_sharp;   // no smooth surface lies across
    uint limit;      // the limit point that it is, or NONE
    uint border;     // word of the bicubic patch across, or NONE
};

Parameter turned(Parameter along)
{
    return Parameter(along.s, along.t);
}

// The half of an edge at its first end, or at the other, as spacing.glsl has the points of an edge of two halves.
Parameter in_half(Parameter along, bool is_second)
{
    precise float near = 0.5 * along.t;
    precise float far = 0.5 + 0.5 * along.s;
    precise float beyond = 0.5 + 0.5 * along.t;
    precise float rest = 0.5 * along.s;
    return is_second ? Parameter(beyond, rest) : Parameter(near, far);
}

// Where a bicubic patch lies across the edge, its position and normal; `border_normal` becomes its normal even where the edge is sharp.
void share_border(Seam seam, Parameter u, Parameter v, inout vec3 position, inout vec3 normal, inout vec3 border_normal)
{
    for (bool is_open = seam.border != NONE && seam.limit == NONE; is_open; is_open = false) {
        BorderPoint border = border_point(seam.border, (seam.edge & 1u) == 0u ? u : v);
        if (!seam.is_sharp || DISPLACED) {
            vec3 p[16];
            border_points(border, p);
            vec4 nu;
            vec4 du;
            vec4 nv;
            vec4 dv;
            cubic_basis(border.u.t, border.u.s, nu, du);
            cubic_basis(border.v.t, border.v.s, nv, dv);
            vec3 along_u;
            vec3 along_v;
            weigh_patch_and_tangents(p, nu, du, nv, dv, position, along_u, along_v);
            position = over_36(position);
            border_normal = without_sign_of_zero(unit_normal(along_u, along_v));
            normal = seam.is_sharp ? normal : border_normal;
        }
        if (seam.is_sharp) {
            vec3 q[4];
            border_curve(border, q);
            position = curve_position(q, border_weights(border));
        }
    }
}

// At a limit point its position and normal.
void share_corner(uint limit, inout vec3 position, inout vec3 normal)
{
    for (bool is_open = limit != NONE; is_open; is_open = false) {
        SceneTables scene = push.frame.v.scene;
        Object object = scene.v.objects.v[patch_places.y];
        LimitPoint point = scene.v.limits.v[limit];
        position = to_world(object, point.position);
        normal = normal_to_world(object, point.normal);
    }
}
#endif
