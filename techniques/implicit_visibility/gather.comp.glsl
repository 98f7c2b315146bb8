// Gathers at leaves over their bins (limn::radiosity::gather): a work group for each leaf. SKY, MEDIUM as in
// bin_lookup.glsl.
#define THREADS 64
#include "glsl/numeric/work_group.glsl"
#include "techniques/implicit_visibility/bin_lookup.glsl"

layout(local_size_x = THREADS) in;
layout(std430) readonly buffer Leaves { Leaf leaves[]; };
#if !SKY && !GLOSSY
layout(std430) readonly buffer Direct { vec4 direct[]; };
layout(std430) writeonly buffer Next { vec4 next[]; };
#endif
layout(std430) writeonly buffer Irradiance { vec4 irradiance[]; };
uniform uint first_leaf;
uniform uint leaf_count;

// The thread's share of the bins: light and weights.
vec4 gathered(uint row, vec3 place, vec3 normal) {
  vec4 sum = vec4(0.0);
  for (uint bin = gl_LocalInvocationIndex; bin < bin_count; bin += uint(THREADS)) {
    BinDirection to = directions[bin];
    float weight = to.solid_angle * dot(normal, to.direction);
    if (weight > 0.0) sum += weight * vec4(bin_radiance(row, bin, place, to.direction), 1.0);
  }
  return sum;
}

void main() {
  uint row = work_group_index();
  if (row >= leaf_count) return;
  uint slot = first_leaf + row;
  Leaf leaf = leaves[slot];
  vec3 normal = to_bins(leaf.normal.xyz);
  vec4 sum = total(gathered(row, leaf.position.xyz, normal));
  if (gl_LocalInvocationIndex > 0u) return;
  vec3 light = leaf.used > 0.0 && sum.w > 0.0 ? pi / sum.w * sum.rgb : vec3(0.0);
  irradiance[slot] = vec4(light, 0.0);
#if !SKY && !GLOSSY
  next[slot] = vec4(direct[slot].rgb + leaf.albedo * light * inverse_pi, 0.0);
#endif
}
