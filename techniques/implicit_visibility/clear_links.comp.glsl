// Bins that hold no link: a work group for each leaf.
#include "techniques/implicit_visibility/elements.glsl"

layout(local_size_x = 64) in;
layout(std430) writeonly buffer Links { uint links[]; };
layout(std430) writeonly buffer Distances { float distances[]; };
uniform uint leaf_count;

void main() {
  uint row = work_group_index();
  if (row >= leaf_count) return;
  for (uint bin = gl_LocalInvocationIndex; bin < bin_count; bin += 64u) {
    links[row * bin_count + bin] = no_link;
    distances[row * bin_count + bin] = 3.0e38;
  }
}
