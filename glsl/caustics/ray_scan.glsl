// Running sums of numbers of rays, by kind, over the LENGTH threads of a work group.
#ifndef LIMN_RAY_SCAN_GLSL
#define LIMN_RAY_SCAN_GLSL

layout(local_size_x = LENGTH) in;
#define LINES 1
#define LOCAL_LINE 0
#define LOCAL_POSITION int(gl_LocalInvocationIndex)
#define SUM_TYPE uvec3
#define SUM(a, b) ((a) + (b))
#include "glsl/numeric/group_scan.glsl"

#endif  // LIMN_RAY_SCAN_GLSL
