// Radiance of the elements of one level: the mean of their children's, weighted by area; with GLOSSY, of a thread for each
// direction, by the area that shows there.
#include "techniques/implicit_visibility/elements.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Groups { ElementGroup groups[]; };
layout(std430) buffer Outgoing { vec4 outgoing[]; };
uniform uint first_group;
uniform uint group_count;

void main() {
  uint item = work_item_index();
  uint index = item / sent_count;
  uint sent = item % sent_count;
  if (index >= 4u * group_count) return;
  uint group = first_group + index / 4u;
  uint lane = index % 4u;
  if (lane >= groups[group].lanes) return;
  uint children = groups[group].children + lane;
  ElementGroup g = groups[children];
  vec3 direction = sent_direction(sent);
  vec3 sum = vec3(0.0);
  float area = 0.0;
  for (uint k = 0u; k < g.lanes; ++k) {
#if GLOSSY
    float shown = g.area[k] * max(dot(vec3(g.nx[k], g.ny[k], g.nz[k]), direction), 0.0);
#else
    float shown = g.area[k];
#endif
    sum += shown * outgoing[(4u * children + k) * sent_count + sent].rgb;
    area += shown;
  }
  outgoing[(4u * group + lane) * sent_count + sent] = vec4(sum / max(area, 1e-37), 0.0);
}
