// Radiance of the elements of one level: the mean of their children's, weighted by area.
#include "glsl/direction_bins.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Groups { ElementGroup groups[]; };
layout(std430, binding = 1) buffer Outgoing { vec4 outgoing[]; };
uniform uint first_group;
uniform uint group_count;

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= 4u * group_count) return;
  uint group = first_group + index / 4u;
  uint lane = index % 4u;
  uvec4 info = groups[group].info;
  if (lane >= info.y) return;
  uint children = info.x + lane;
  ElementGroup g = groups[children];
  vec3 sum = vec3(0.0);
  float area = 0.0;
  for (uint k = 0u; k < g.info.y; ++k) {
    sum += g.area[k] * outgoing[4u * children + k].rgb;
    area += g.area[k];
  }
  outgoing[4u * group + lane] = vec4(sum / max(area, 1e-37), 0.0);
}
