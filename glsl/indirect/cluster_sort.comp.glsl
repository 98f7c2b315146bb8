// Virtual lights of each sub-buffer in the order of their clusters, so that a pixel asks for the visibility of a cluster
// once; `cluster` is set in the result.
//
// llvmpipe leaves all loops of a thread after 65,535 steps in all, and a sub-buffer has up to 65,536 lights: a step takes two.
#include "glsl/indirect/gather.glsl"
#include "glsl/indirect/virtual_area_light.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
layout(std430) writeonly buffer Sorted { VirtualPointLight sorted[]; };
layout(std430) readonly buffer Mapping { uint mapping[]; };
uniform uint light_count;
uniform uint block;  // side of the pattern of sub-buffers

// Whether light j comes before light i, which is in `cluster`.
bool comes_before(uint j, uint i, uint cluster) { return mapping[j] < cluster || (mapping[j] == cluster && j < i); }

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= light_count) return;
  uint sub_buffer = gather_sub_buffer(i, light_count, block);
  uint first = gather_begin(sub_buffer, light_count, block);
  uint end = gather_begin(sub_buffer + 1u, light_count, block);
  uint cluster = mapping[i];
  uint rank = 0u;
  for (uint j = first; j < end; j += 2u) {
    if (comes_before(j, i, cluster)) ++rank;
    if (j + 1u < end && comes_before(j + 1u, i, cluster)) ++rank;
  }
  VirtualPointLight light = virtual_lights[i];
  light.cluster = float(cluster);
  sorted[first + rank] = light;
}
