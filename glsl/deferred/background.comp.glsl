// What the camera sees before any light is added: emission of surfaces, the environment behind them.
#include "glsl/deferred/gbuffer_input.glsl"
#include "glsl/equirectangular.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) writeonly uniform image2D radiance;
#if ENVIRONMENT
layout(binding = 7) uniform sampler2D environment_map;
#endif

vec3 background(ivec2 pixel) {
#if ENVIRONMENT
  vec3 direction = environment_lookup_direction(normalize(pixel_ray(pixel)), frame.environment.x);
  return frame.environment.y * textureLod(environment_map, equirectangular_uv(direction), 0.0).rgb;
#else
  return vec3(0.0);
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size.xy)))) return;
#if GEOMETRY
  bool covered = pixel_depth(pixel) > 0.0;
  vec3 light = covered ? texelFetch(gbuffer_emission, pixel, 0).rgb : background(pixel);
#else
  vec3 light = background(pixel);
#endif
  imageStore(radiance, pixel, vec4(light, 1.0));
}
