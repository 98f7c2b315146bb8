// T_cam: the medium between what a pixel shows and the camera.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/media/medium_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec3 ray = pixel_ray(pixel);
  float metres_per_depth = length(ray);
  float depth = pixel_depth(pixel);
  float end = depth > 0.0 ? depth * metres_per_depth : 3.0e38;
  Medium medium = scene_medium();
  float inside = medium_length(medium, frame.camera_position.xyz, ray / metres_per_depth, end);
  vec4 seen = imageLoad(radiance, pixel);
  imageStore(radiance, pixel, vec4(seen.rgb * medium_transmittance(medium, inside), seen.a));
}
