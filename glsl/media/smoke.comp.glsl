// Smoke at the centres of the voxels of its grid (glsl/media/smoke.glsl).
#include "glsl/media/smoke.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(r32f) writeonly uniform image3D density;

void main() {
  uvec3 voxel = gl_GlobalInvocationID;
  if (any(greaterThanEqual(voxel, smoke.voxels))) return;
  vec3 place = mix(smoke.low, smoke.high, (vec3(voxel) + 0.5) / vec3(smoke.voxels));
  float value = smoke_density(smoke.low, smoke.high, smoke.risen, smoke.whirl, smoke.seed, place);
  imageStore(density, ivec3(voxel), vec4(value, 0.0, 0.0, 0.0));
}
