// How much of each light each leaf sees: points of the light are hidden where the link in their bin is shorter. That is the
// sum of equation 4.4 with the visibility of 4.5, so that lights smaller than a bin keep their size.
#include "glsl/light/light_view.glsl"
#include "glsl/numeric/sampling.glsl"
#include "techniques/implicit_visibility/elements.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer Leaves { Leaf leaves[]; };
layout(std430) readonly buffer Links { uint links[]; };
layout(std430) readonly buffer Groups { ElementGroup groups[]; };
layout(std430) readonly buffer Indices { uint indices[]; };
layout(std430) writeonly buffer Seen { float seen[]; };
uniform uint first_leaf;  // of those whose links are bound
uniform uint leaf_count;
uniform uint slots;
uniform uint samples;
uniform float unit;   // metres
uniform float reach;  // a blocker is nearer than this part of the way, so that lights at a surface are not hidden by it

// Whether the light's point with this slope is visible.
bool clear(uint slot, Light light, LightView v, vec3 slope) {
  uint link = links[(slot - first_leaf) * bin_count + bin_of(to_bins(slope), BINS)];
  if (link == no_link) return true;
  uint element = link & ~link_back;
  ElementGroup g = groups[element / 4u];
  if (light_is_instance(light, g.object)) return true;  // a light does not hide itself
  ElementGroup own = groups[slot / 4u];
  uint k = element % 4u;
  uint i = slot % 4u;
  vec3 offset = vec3(g.x[k], g.y[k], g.z[k]) - vec3(own.x[i], own.y[i], own.z[i]);
  float distance = light.type == light_directional ? 3.0e38 : length(slope) * v.depth;  // metres
  return length(offset) * unit > reach * distance;
}

void main() {
  uint slot = first_leaf + gl_GlobalInvocationID.x;
  if (gl_GlobalInvocationID.x >= leaf_count) return;
  Leaf leaf = leaves[slot];
  float lit = 1.0;
  Light light = lights[indices[gl_WorkGroupID.y]];
  LightView v = light_view(light, leaf.position.xyz, leaf.normal.xyz, -1.0);
  if (leaf.used > 0.0 && !v.masked) {
    float total = 0.0;
    float hits = 0.0;
    uint count = v.extended ? samples : 1u;
    for (uint s = 0u; s < count; ++s) {
      vec3 slope = v.centre;
      if (v.extended && !light_view_sample(v, r2_point(s, count), slope)) continue;
      total += 1.0;
      if (clear(slot, light, v, slope)) hits += 1.0;
    }
    if (total == 0.0) {
      total = 1.0;
      if (clear(slot, light, v, light_view_single_point(v))) hits = 1.0;
    }
    lit = hits / total;
  }
  seen[gl_WorkGroupID.y * slots + slot] = lit;
}
