// What the control shaders of ACC and Pm-patches hand on besides points. Included after levels.glsl.
#ifndef PLANISH_RIVAL_ENTRY
#define PLANISH_RIVAL_ENTRY
void put_patch(SceneTables scene, Object object, DrawEntry entry)
{
    PatchInfo info = scene.v.irregular.v[entry.place].info;
    patch_words = uvec4(object.first_face + info.ptex_face, info.corner, info.flags,
                        (push.first_patch_id + entry.place) | ((object.flags & OBJECT_MIRRORED) != 0u ? PATCH_MIRRORED : 0u));
    patch_places = uvec2(entry.place, entry.object);
    set_factors(entry_factors(entry), entry.flags);
}
#endif
