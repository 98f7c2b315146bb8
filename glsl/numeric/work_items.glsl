// Numbers of work groups and work items, 64 in a group, where PassContext::dispatchRows() puts the groups in rows.
#ifndef LIMN_WORK_ITEMS_GLSL
#define LIMN_WORK_ITEMS_GLSL

uint work_group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint work_item_index() { return 64u * work_group_index() + gl_LocalInvocationIndex; }

#endif  // LIMN_WORK_ITEMS_GLSL
