// Main function of the pass that sorts rays by kind. Include behind `uint ray_kind(int index)`, 0 to 2 or ray_kind_none.
#include "glsl/caustics/ray_runs.glsl"

#define LENGTH int(runs_per_group)
#include "glsl/caustics/ray_scan.glsl"

layout(std430) writeonly buffer RayRuns { RayRun runs[]; };
layout(std430) writeonly buffer RayGroups { RayGroup groups[]; };
uniform int ray_count;

void main() {
  uint run = gl_GlobalInvocationID.x;
  uint first = run * rays_per_run;
  uvec3 counts = uvec3(0u);
  uint kinds = 0u;
  for (uint i = 0u; i < rays_per_run; ++i) {
    uint kind = first + i < uint(ray_count) ? ray_kind(int(first + i)) : ray_kind_none;
    counts += uvec3(equal(uvec3(kind), uvec3(0u, 1u, 2u)));
    kinds |= kind << (2u * i);
  }
  uvec3 all;
  uvec3 before = scan_line(counts, all);
  if (first < uint(ray_count)) runs[run] = RayRun(kinds, pack_counts(before));
  if (gl_LocalInvocationIndex == 0u) groups[gl_WorkGroupID.x] = RayGroup(all, 0u);
}
