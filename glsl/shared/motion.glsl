// Where points of the surface are at the next moment.
#ifndef PLANISH_MOTION
#define PLANISH_MOTION
#include "scene.glsl"

// In the world: of a point in the mesh's own space at the next moment, where the mesh deforms, else in the world now.
vec3 moved_on(Object object, vec3 p)
{
    return ((object.motion[0] * p.x + object.motion[1] * p.y) + object.motion[2] * p.z) + object.motion[3];
}

// Of a limit point, which is at `position` in the world now.
vec3 next_limit(SceneTables scene, Object object, uint limit, vec3 position)
{
    vec3 p = position;
    for (bool is_open = (object.flags & OBJECT_DEFORMS) != 0u; is_open; is_open = false) {
        p = scene.v.next_limits.v[limit].position;
    }
    return moved_on(object, p);
}
#endif
