// Flux that each tile of TILE x TILE texels of each layer reflects, W.
#define THREADS 256
#include "glsl/indirect/reflective_texel.glsl"
#include "glsl/numeric/work_group.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(std430) writeonly buffer Tiles { vec4 tiles[]; };

void main() {
  ShadowView view = views[gl_WorkGroupID.z];
  ivec2 size = ivec2(view.size);
  ivec2 last = min((ivec2(gl_WorkGroupID.xy) + 1) * TILE, size);
  vec3 sum = vec3(0.0);
  for (int y = int(gl_WorkGroupID.y) * TILE + int(gl_LocalInvocationID.y); y < last.y; y += 16)
    for (int x = int(gl_WorkGroupID.x) * TILE + int(gl_LocalInvocationID.x); x < last.x; x += 16)
      sum += reflective_texel(view, ivec2(x, y)).flux;
  vec4 flux = total(vec4(sum / (float(size.x) * float(size.y)), 0.0));
  uint tile = (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (gl_LocalInvocationIndex == 0u) tiles[tile] = flux;
}
