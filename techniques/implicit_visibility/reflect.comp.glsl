// What leaves send into a bin of directions: the BRDF over the bins of what they see, and what they reflect of lights.
// A thread for each leaf and direction. SKY, MEDIUM as in bin_lookup.glsl.
#include "techniques/implicit_visibility/bin_reflection.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Leaves { Leaf leaves[]; };
layout(std430) readonly buffer Irradiance { vec4 irradiance[]; };  // of the same light
#if SKY
layout(std430) buffer Direct { vec4 direct[]; };  // becomes the same as next, which is pulled up
#else
layout(std430) readonly buffer Direct { vec4 direct[]; };
#endif
layout(std430) writeonly buffer Next { vec4 next[]; };
layout(std430) readonly buffer Materials { SurfaceBrdf materials[]; };  // limn::radiosity::LeafMaterial
uniform uint first_leaf;
uniform uint leaf_count;

void main() {
  uint item = work_item_index();
  uint row = item / sent_count;
  if (row >= leaf_count) return;
  uint slot = first_leaf + row;
  uint at = slot * sent_count + item % sent_count;
  Leaf leaf = leaves[slot];
  SurfaceBrdf surface = binned_brdf(materials[slot]);
  vec3 n = to_bins(leaf.normal.xyz);
  vec3 view = sent_direction(item % sent_count);
  vec3 sum = direct[at].rgb;
  if (leaf.used > 0.0 && dot(n, view) > 0.0) {
    if (brdf_is_lambertian(surface)) {
      sum += surface.diffuse * irradiance[slot].rgb * inverse_pi;
    } else {
      sum += reflected(row, leaf.position.xyz, surface, n, n, view);
    }
  }
  next[at] = vec4(sum, 0.0);
#if SKY
  direct[at] = vec4(sum, 0.0);
#endif
}
