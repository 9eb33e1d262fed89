#version 460
// One thread turns one word of marks into a part of the list of what is marked, and clears it. A group has words of one phase
// alone and takes its run of that list at once, in ascending order: rows that are neighbours in memory stay so.
#extension GL_GOOGLE_include_directive : require
#include "shared/append.glsl"
layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    SceneTables scene;
} push;

shared uint counts[64];
shared uint first_place;

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (group >= push.scene.v.mark_group_count) {
        return;
    }
    uint thread = gl_LocalInvocationID.x;
    uint place = group * 64u + thread;
    uint word = push.scene.v.marks.v[place];
    counts[thread] = bitCount(word);
    if (word != 0u) {
        push.scene.v.marks.v[place] = 0u;
    }
    barrier();
    MarkGroup own = push.scene.v.mark_groups.v[group];
    if (thread == 0u) {
        // Few groups have many marks: a plain sum is short.
        uint sum = 0u;
        for (uint i = 0; i < 64; ++i) {
            uint count = counts[i];
            counts[i] = sum;
            sum += count;
        }
        first_place = own.first_item + (sum == 0u ? 0u : take_places(push.scene.v.heads, LIST_PHASES + own.phase, sum));
    }
    barrier();
    uint to = first_place + counts[thread];
    while (word != 0u) {
        uint bit = uint(findLSB(word));
        word &= word - 1u;
        push.scene.v.in_use.v[to] = own.first + 32u * thread + bit;
        ++to;
    }
}
