// Caustic rays in order of what they are drawn as. The buffer is cut into runs; of each, how many rays of each kind it holds
// is counted, the counts are summed over all runs before it, and the rays are listed from there on. So no vertex is spent on rays
// that are not drawn, and since nothing hangs on which thread comes first, a list is the same to the bit every time.
// core/caustics/ray_lists.h runs the three passes.
#ifndef LIMN_RAY_RUNS_GLSL
#define LIMN_RAY_RUNS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint ray_kinds = 3u;
LIMN_CONST uint ray_kind_none = 3u;  // drawn as nothing
LIMN_CONST uint rays_per_run = 16u;  // two bits each

// Storage buffer element.
struct RayRun {
  uvec3 places;  // by kind: first how many rays of it are in the run, then where in the list they begin
  uint kinds;    // of the rays, from the lowest bits on
};

// As glDrawArraysIndirect takes it.
struct RayDraw {
  uint vertices;
  uint instances;
  uint first_vertex;
  uint first_instance;
};

LIMN_END
#endif  // LIMN_RAY_RUNS_GLSL
