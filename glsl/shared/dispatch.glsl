// Linear index of a compute thread: grids of more than 65535 groups are folded into y.
#ifndef PLANISH_DISPATCH
#define PLANISH_DISPATCH
uint thread_index()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
#endif
