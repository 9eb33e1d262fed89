#version 460
// One thread moves one vertex of a cage that deforms: morph targets, then linear blend skinning. After the cages were copied to
// the points, before anything looks at these.
#extension GL_GOOGLE_include_directive : require
#include "shared/tables.glsl"
layout(local_size_x = 64) in;
#include "shared/dispatch.glsl"

// A vertex, and where what moves it begins.
struct DeformedVertex {
    uint point;
    uint first_offset;    // offsets of morph targets: targets ascend
    uint offset_count;
    uint first_influence; // of joints
    uint influence_count;
};

// A morph target's offset of one vertex.
struct MorphOffset {
    uint weight; // its place among the weights
    vec3 offset;
};

// A joint's share in a vertex.
struct JointInfluence {
    uint joint;
    float weight;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer DeformedVertices { DeformedVertex v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MorphOffsets { MorphOffset v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer JointInfluences { JointInfluence v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer JointMaps { mat4x3 v[]; };

layout(push_constant, scalar) uniform Push {
    Points points;
    DeformedVertices vertices;
    MorphOffsets offsets;
    JointInfluences influences;
    Weights morph_weights; // at this moment
    JointMaps joints;      // likewise: from the cage to where they have moved it
    uint vertex_count;
} push;

vec3 joint_moved(uint joint, vec3 p)
{
    precise vec3 moved = ((push.joints.v[joint][0] * p.x + push.joints.v[joint][1] * p.y) + push.joints.v[joint][2] * p.z)
                       + push.joints.v[joint][3];
    return moved;
}

void main()
{
    uint thread = thread_index();
    if (thread >= push.vertex_count) {
        return;
    }
    DeformedVertex vertex = push.vertices.v[thread];
    precise vec3 p = push.points.v[vertex.point];
    for (uint i = 0; i < vertex.offset_count; ++i) {
        MorphOffset morph = push.offsets.v[vertex.first_offset + i];
        p = p + push.morph_weights.v[morph.weight] * morph.offset;
    }
    precise vec3 sum = vec3(0.0);
    for (uint i = 0; i < vertex.influence_count; ++i) {
        JointInfluence influence = push.influences.v[vertex.first_influence + i];
        sum = sum + joint_moved(influence.joint, p) * influence.weight;
    }
    push.points.v[vertex.point] = vertex.influence_count > 0u ? sum : p;
}
