// Caustic rays in order of what they are drawn as. The buffer is cut into runs, each of which a thread sorts, and the runs into
// groups, each a work group. Of each group, how many rays of each kind it holds is counted, the counts are summed over all groups
// before it, and the rays are listed from there on: a scan over as many work groups as there are. So no vertex is spent on rays
// that are not drawn, and since nothing hangs on which thread comes first, a list is the same to the bit every time.
// core/caustics/ray_lists.h runs the three passes.
#ifndef LIMN_RAY_RUNS_GLSL
#define LIMN_RAY_RUNS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint ray_kinds = 3u;
LIMN_CONST uint ray_kind_none = 3u;  // drawn as nothing
LIMN_CONST uint rays_per_run = 16u;  // two bits each

LIMN_CONST uint runs_per_group = 64u;

// Storage buffer element.
struct RayRun {
  uint kinds;   // of the rays, from the lowest bits on
  uint before;  // how many rays of each kind are in the runs of the group before this one, ten bits each
};

// Storage buffer element.
struct RayGroup {
  uvec3 places;  // by kind: first how many rays of it are in the group, then how many are in the groups before
  uint unused;
};

// As glDrawArraysIndirect takes it.
struct RayDraw {
  uint vertices;
  uint instances;
  uint first_vertex;
  uint first_instance;
};

LIMN_FN uint pack_counts(uvec3 counts) { return counts.x | (counts.y << 10u) | (counts.z << 20u); }
LIMN_FN uvec3 unpack_counts(uint bits) { return uvec3(bits & 1023u, (bits >> 10u) & 1023u, bits >> 20u); }

LIMN_END
#endif  // LIMN_RAY_RUNS_GLSL
