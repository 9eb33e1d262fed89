#version 460
// Regular and transition patches: fetches 16 control points and sets the tess factors (FAS sections 4.1 and 4.2).
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.glsl"
#include "shared/control_points.glsl"
#include "shared/entry.glsl"
#include "shared/factors.glsl"

layout(constant_id = 2) const bool CREASE = false; // some patches have a semi-sharp crease
layout(constant_id = 3) const bool CUT = false;    // each is a piece of a patch
layout(vertices = 16) out;
layout(location = 0) in uint list_place[];
layout(location = 0) out vec3 control_point[];
layout(location = 1) patch out vec4 low_factors;  // spaced factor of each edge, or of the half with the lower u or v
layout(location = 2) patch out vec4 high_factors; // of the other half where the edge is split, else 0
layout(location = 3) patch out vec2 inner_factors; // along u and v; -n for n segments of one length
layout(location = 4) patch out uvec4 patch_words; // its PatchInfo, and its number
layout(location = 5) patch out float patch_sharpness; // of the semi-sharp crease along one of its edges, or 0
// Of a piece: its place and how many there are a side; points of the patch's edges.
layout(location = 6) patch out uvec3 piece_place;
layout(location = 7) patch out uvec4 piece_first;
layout(location = 8) patch out uvec4 piece_last;
layout(location = 9) patch out uvec2 patch_places; // of its seams, or NONE; of its object

#include "shared/levels.glsl"

void main()
{
    uint patch_place = push.list.v[list_place[0]].place;
    PatchInfo info = push.patches.v[patch_place].info;
    SceneTables scene = push.frame.v.scene;
    Object object = scene.v.objects.v[push.list.v[list_place[0]].object];
    control_point[gl_InvocationID] = to_world(
        object, control_point_of(push.patches, push.points, patch_place, gl_InvocationID, patch_boundary(info)));
    if (gl_InvocationID != 0) {
        return;
    }
    DrawEntry entry = push.list.v[list_place[0]];
    uint flags = entry.flags;
    patch_sharpness = CREASE ? push.patches.v[patch_place].sharpness : 0.0;
    PatchFactors factors = entry_factors(entry);
    patch_words = uvec4(object.first_face + info.ptex_face, info.corner, info.flags | entry_split_edges(flags) << 14,
                        (push.first_patch_id + patch_place) | ((object.flags & OBJECT_MIRRORED) != 0u ? PATCH_MIRRORED : 0u));
    patch_places = uvec2(push.patches.v[patch_place].seams, entry.object);
    set_factors(factors, flags);
}
