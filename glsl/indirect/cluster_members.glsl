// Work groups that each look at the virtual lights of one cluster, and sum up what they find (glsl/numeric/work_group.glsl), so
// that frames of the same lights are the same to the bit.
#ifndef LIMN_CLUSTER_MEMBERS_GLSL
#define LIMN_CLUSTER_MEMBERS_GLSL
#include "glsl/indirect/virtual_area_light.glsl"

#define THREADS 64
#include "glsl/numeric/work_group.glsl"
layout(local_size_x = THREADS) in;
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
layout(std430) buffer Clusters { VirtualAreaLight clusters[]; };
layout(std430) readonly buffer Mapping { uint mapping[]; };
uniform uint light_count;

bool member(uint i) { return mapping[i] == gl_WorkGroupID.x && virtual_light_shines(virtual_lights[i]); }

#endif  // LIMN_CLUSTER_MEMBERS_GLSL
