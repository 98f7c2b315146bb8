// Specular radiance that each leaf sends towards the eye.
#include "glsl/numeric/work_items.glsl"
#include "glsl/scene/blocks.glsl"
#include "techniques/illumination_samples/leaf_tree.glsl"

layout(local_size_x = 64) in;
layout(std430) writeonly buffer Towards { vec4 towards[]; };
uniform uint leaf_count;

void main() {
  uint slot = work_item_index();
  if (slot >= leaf_count) return;
  vec3 view = normalize(frame.camera_position.xyz - leaves[slot].vertex);
  towards[slot] = vec4(leaf_radiance(slot, view), 0.0);
}
