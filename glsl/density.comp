#version 460
// One thread finds the density at one vertex of an object: the mean of its edges' (DFAS section 6.1, the metric). An edge's is
// the projected diameter of its bounding sphere, so that it does not vanish at silhouettes, over the length that edges should
// have.
#extension GL_GOOGLE_include_directive : require
#include "shared/append.glsl"
layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    SceneTables scene;
} push;

// Densities are bounded, so that all sums of them are finite and no patch is cut into more than 256 x 256 pieces, whatever the spacing.
const float MAX_DENSITY = 16000.0;
// Spheres nearer than this many radii are taken to be as far.
const float LEAST_DISTANCE = 0.25;

shared uint largest_bits;

float bounded(float density)
{
    // NaN is no density.
    return density > 0.0 ? min(density, MAX_DENSITY) : 0.0;
}

float sphere_density(FrameInput frame, vec3 centre, float radius)
{
    precise vec3 d = centre - frame.view.eye;
    precise float distance = sqrt(precise_dot(d, d));
    precise float depth = precise_dot(frame.view.clip_w, d);
    precise float beside = frame.least_cosine * distance;
    precise float nearest = LEAST_DISTANCE * radius;
    precise float away = max(max(depth, beside), nearest);
    // What lies behind the eye is not seen: its density goes to 0 over the length of a radius.
    precise float behind = depth / radius + 2.0;
    precise float fade = clamp(behind, 0.0, 1.0);
    precise float density = ((radius * frame.edge_scale) / away) * fade;
    return density;
}

float vertex_density(FrameInput frame, Object object, uint vertex)
{
    if (frame.density > 0.0) {
        return frame.density;
    }
    if (frame.object_lod != 0u) {
        precise vec3 centre = 0.5 * (object.low + object.high);
        precise float radius = 0.5 * object.largest_edge;
        return sphere_density(frame, to_world(object, centre), radius);
    }
    uint slot = object.first_mesh_slot + vertex;
    vec3 a = to_world(object, push.scene.v.points.v[object.first_point + vertex]);
    precise float sum = 0.0;
    uint first = push.scene.v.neighbour_first.v[slot];
    uint end = push.scene.v.neighbour_first.v[slot + 1];
    for (uint i = first; i < end; ++i) {
        vec3 b = to_world(object, push.scene.v.points.v[object.first_point + push.scene.v.neighbours.v[i]]);
        precise vec3 centre = 0.5 * (a + b);
        precise vec3 edge = b - a;
        precise float radius = 0.5 * sqrt(precise_dot(edge, edge));
        sum += bounded(sphere_density(frame, centre, radius));
    }
    precise float mean = sum / float(max(end - first, 1u));
    return mean;
}

void main()
{
    uint chunk = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (gl_LocalInvocationID.x == 0u) {
        largest_bits = 0u;
    }
    barrier();
    if (chunk < push.scene.v.heads.v[LIST_VERTICES].count) {
        ListItem item = push.scene.v.chunks.v[push.scene.v.chunk_first[0] + chunk];
        Object object = push.scene.v.objects.v[item.object];
        uint vertex = item.place + gl_LocalInvocationID.x;
        if (vertex < object.vertex_count) {
            FrameInput frame = push.scene.v.frame_input.v;
            precise float scaled = vertex_density(frame, object, vertex) * push.scene.v.density_scales.v[object.first_point + vertex];
            float density = bounded(scaled);
            vec3 position = to_world(object, push.scene.v.points.v[object.first_point + vertex]);
            uint outside = frame.view.cull == 0u ? 0u : point_outside_planes(position, frame.view, object.displacement);
            push.scene.v.densities.v[object.first_slot + vertex].density = density;
            push.scene.v.densities.v[object.first_slot + vertex].outside = outside;
            // Bits of numbers that are not negative are in their order.
            atomicMax(largest_bits, floatBitsToUint(density));
        }
    }
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        atomicMax(push.scene.v.counts.v.density_bits, largest_bits);
    }
}
