// Lists the rays of each run from its places on.
#include "glsl/caustics/ray_runs.glsl"

layout(local_size_x = runs_per_group) in;
layout(std430) readonly buffer RayRuns { RayRun runs[]; };
layout(std430) readonly buffer RayGroups { RayGroup groups[]; };
layout(std430) readonly buffer RayDraws {
  RayDraw draws[ray_kinds];
  uint first_places[ray_kinds];
};
layout(std430) writeonly buffer RayIndices { uint ray_indices[]; };
uniform int run_count;

void main() {
  uint run = gl_GlobalInvocationID.x;
  if (run >= uint(run_count)) return;
  uint kinds = runs[run].kinds;
  uvec3 place = uvec3(first_places[0], first_places[1], first_places[2]) + groups[gl_WorkGroupID.x].places +
                unpack_counts(runs[run].before);
  for (uint i = 0u; i < rays_per_run; ++i) {
    uint kind = (kinds >> (2u * i)) & 3u;
    if (kind == ray_kind_none) continue;
    ray_indices[place[kind]] = run * rays_per_run + i;
    ++place[kind];
  }
}
