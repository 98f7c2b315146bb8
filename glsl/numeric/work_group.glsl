// What all threads of a work group have, in one value. Define THREADS, the size of the group and a power of two. The order
// is fixed, so that the same values give the same bits, which atomics do not on GPUs. All threads must call.
#ifndef LIMN_WORK_GROUP_GLSL
#define LIMN_WORK_GROUP_GLSL

shared vec4 partial[THREADS];

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

#endif  // LIMN_WORK_GROUP_GLSL
