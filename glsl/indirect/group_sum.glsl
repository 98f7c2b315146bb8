// The sum of a value over a work group of GROUP invocations, a power of two.
#ifndef LIMN_GROUP_SUM_GLSL
#define LIMN_GROUP_SUM_GLSL

shared vec3 group_values[GROUP];

// Called by all invocations together; the result is right in invocation 0.
vec3 group_sum(vec3 value) {
  uint self = gl_LocalInvocationIndex;
  group_values[self] = value;
  barrier();
  for (uint reach = uint(GROUP) / 2u; reach > 0u; reach /= 2u) {
    if (self < reach) group_values[self] += group_values[self + reach];
    barrier();
  }
  return group_values[0];
}

#endif  // LIMN_GROUP_SUM_GLSL
