// Where in the lists the rays of each group begin, and what draws the lists: one work group of LENGTH threads, which take LENGTH
// groups of rays at a time. RAY_VERTICES: uvec3, vertices of each ray, by kind; INSTANCE_RAYS: uvec3, 1 where each ray is an
// instance.
#include "glsl/caustics/ray_runs.glsl"
#include "glsl/caustics/ray_scan.glsl"

layout(std430) buffer RayGroups { RayGroup groups[]; };
layout(std430) writeonly buffer RayDraws {
  RayDraw draws[ray_kinds];
  uint first_places[ray_kinds];
};
uniform int group_count;
const uvec3 ray_vertices = RAY_VERTICES;
const uvec3 instance_rays = INSTANCE_RAYS;

void main() {
  uvec3 total = uvec3(0u);
  for (int start = 0; start < group_count; start += LENGTH) {
    int group = start + LOCAL_POSITION;
    uvec3 all;
    uvec3 before = scan_line(group < group_count ? groups[group].places : uvec3(0u), all);
    if (group < group_count) groups[group].places = total + before;
    total += all;
  }
  if (LOCAL_POSITION > 0) return;
  uvec3 first = uvec3(0u, total.x, total.x + total.y);
  for (uint kind = 0u; kind < ray_kinds; ++kind) {
    bool instances = instance_rays[kind] != 0u;
    draws[kind] = RayDraw(ray_vertices[kind] * (instances ? 1u : total[kind]), instances ? total[kind] : 1u, 0u, 0u);
    first_places[kind] = first[kind];
  }
}
