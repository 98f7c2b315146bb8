// Where in the list the rays of each run begin, and what draws the list: one work group, each thread a share of the runs.
// RAY_VERTICES: uvec3, vertices of each ray, by kind; INSTANCE_RAYS: uvec3, 1 where each ray is an instance.
#include "glsl/caustics/ray_runs.glsl"

layout(local_size_x = THREADS) in;
layout(std430) buffer RayRuns { RayRun runs[]; };
layout(std430) writeonly buffer RayDraws {
  RayDraw draws[ray_kinds];
  uint first_places[ray_kinds];
};
uniform int run_count;
const uvec3 ray_vertices = RAY_VERTICES;
const uvec3 instance_rays = INSTANCE_RAYS;

shared uvec3 sums[THREADS];

void main() {
  uint self = gl_LocalInvocationIndex;
  uint share = (uint(run_count) + THREADS - 1u) / THREADS;
  uint from = min(self * share, uint(run_count));
  uint to = min(from + share, uint(run_count));
  uvec3 sum = uvec3(0u);
  for (uint i = from; i < to; ++i) sum += runs[i].places;
  sums[self] = sum;
  barrier();
  if (self == 0u) {
    uvec3 total = uvec3(0u);
    for (uint i = 0u; i < THREADS; ++i) {
      uvec3 own = sums[i];
      sums[i] = total;
      total += own;
    }
    uvec3 first = uvec3(0u, total.x, total.x + total.y);
    for (uint i = 0u; i < THREADS; ++i) sums[i] += first;
    for (uint kind = 0u; kind < ray_kinds; ++kind) {
      bool instances = instance_rays[kind] != 0u;
      draws[kind] = RayDraw(ray_vertices[kind] * (instances ? 1u : total[kind]), instances ? total[kind] : 1u, 0u, 0u);
      first_places[kind] = first[kind];
    }
  }
  barrier();
  uvec3 place = sums[self];
  for (uint i = from; i < to; ++i) {
    uvec3 count = runs[i].places;
    runs[i].places = place;
    place += count;
  }
}
