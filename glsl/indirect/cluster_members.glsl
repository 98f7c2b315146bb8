// Work groups that each look at the virtual lights of one cluster, and sum up what they find. The order of summation is
// fixed, so that frames of the same lights are the same to the bit, which additive blending and atomics are not on GPUs.
#ifndef LIMN_CLUSTER_MEMBERS_GLSL
#define LIMN_CLUSTER_MEMBERS_GLSL
#include "glsl/virtual_area_light.glsl"

#define THREADS 64
layout(local_size_x = THREADS) in;
layout(std430, binding = 0) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
layout(std430, binding = 1) buffer Clusters { VirtualAreaLight clusters[]; };
layout(std430, binding = 2) readonly buffer Mapping { uint mapping[]; };
uniform uint light_count;

shared vec4 partial[THREADS];

bool member(uint i) { return mapping[i] == gl_WorkGroupID.x && virtual_light_shines(virtual_lights[i]); }

vec4 total(vec4 value) {
  uint self = gl_LocalInvocationIndex;
  partial[self] = value;
  barrier();
  for (uint reach = THREADS / 2u; reach > 0u; reach /= 2u) {
    if (self < reach) partial[self] += partial[self + reach];
    barrier();
  }
  vec4 sum = partial[0];
  barrier();
  return sum;
}

vec4 least(vec4 value) {
  uint self = gl_LocalInvocationIndex;
  partial[self] = value;
  barrier();
  for (uint reach = THREADS / 2u; reach > 0u; reach /= 2u) {
    if (self < reach) partial[self] = min(partial[self], partial[self + reach]);
    barrier();
  }
  vec4 result = partial[0];
  barrier();
  return result;
}

#endif  // LIMN_CLUSTER_MEMBERS_GLSL
