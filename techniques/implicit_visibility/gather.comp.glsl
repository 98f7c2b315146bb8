// Gathers at leaves over their bins (limn::radiosity::gather). SKY as in bin_lookup.glsl. SERIAL 1: a thread for each leaf, for
// renderers whose barriers cost more than loads; 0: a work group.
#define THREADS 64
#if !SERIAL
#include "glsl/numeric/work_group.glsl"
#endif
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

// Every step-th bin from the first on: light and weights.
vec4 gathered(uint row, vec3 normal, uint first, uint step) {
  vec4 sum = vec4(0.0);
  for (uint bin = first; bin < bin_count; bin += step) {
    BinDirection to = directions[bin];
    float weight = to.solid_angle * dot(normal, to.direction);
    if (weight > 0.0) sum += weight * vec4(bin_radiance(row, bin, to.direction), 1.0);
  }
  return sum;
}

void main() {
#if SERIAL
  uint row = gl_GlobalInvocationID.x;
#else
  uint row = work_group_index();
#endif
  if (row >= leaf_count) return;
  uint slot = first_leaf + row;
  Leaf leaf = leaves[slot];
  vec3 normal = to_bins(leaf.normal.xyz);
#if SERIAL
  vec4 sum = gathered(row, normal, 0u, 1u);
#else
  vec4 sum = total(gathered(row, normal, gl_LocalInvocationIndex, uint(THREADS)));
  if (gl_LocalInvocationIndex > 0u) return;
#endif
  vec3 light = leaf.used > 0.0 && sum.w > 0.0 ? pi / sum.w * sum.rgb : vec3(0.0);
  irradiance[slot] = vec4(light, 0.0);
#if !SKY && !GLOSSY
  next[slot] = vec4(direct[slot].rgb + leaf.albedo * light * inverse_pi, 0.0);
#endif
}
