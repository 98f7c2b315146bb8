// Smoke at the centres of the voxels of its grid (glsl/smoke.glsl).
#include "glsl/smoke.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(r32f, binding = 0) writeonly uniform image3D density;

void main() {
  uvec3 voxel = gl_GlobalInvocationID;
  if (any(greaterThanEqual(voxel, smoke.voxels.xyz))) return;
  vec3 place = mix(smoke.low.xyz, smoke.high.xyz, (vec3(voxel) + 0.5) / vec3(smoke.voxels.xyz));
  imageStore(density, ivec3(voxel), vec4(smoke_density(smoke.low, smoke.high, smoke.voxels.w, place), 0.0, 0.0, 0.0));
}
