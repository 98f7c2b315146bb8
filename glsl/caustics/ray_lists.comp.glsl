// Lists the rays of each run from its places on.
#include "glsl/caustics/ray_runs.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer RayRuns { RayRun runs[]; };
layout(std430) writeonly buffer RayIndices { uint ray_indices[]; };
uniform int run_count;

void main() {
  uint run = gl_GlobalInvocationID.x;
  if (run >= uint(run_count)) return;
  uvec3 place = runs[run].places;
  uint kinds = runs[run].kinds;
  for (uint i = 0u; i < rays_per_run; ++i) {
    uint kind = (kinds >> (2u * i)) & 3u;
    if (kind == ray_kind_none) continue;
    ray_indices[place[kind]] = run * rays_per_run + i;
    ++place[kind];
  }
}
