// Irradiance of surfaces that face each direction: the sum over one level of the environment's own picture, whose texels have exact
// solid angles. Texels of the technique's map are sampled, which may miss a narrow sun or have it on both sides of the rim.
// GRAZING 1: of light weighted by Schlick's (1 - cosine)^5.
#include "glsl/light/prefiltered.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2DArray irradiance;
uniform sampler2D environment_levels_map;  // equirectangular
uniform int source_level;
// Into which a texel is cut, where the picture has too few for the sum.
uniform int columns_of_texel;
uniform int rows_of_texel;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec3 extent = imageSize(irradiance);
  if (any(greaterThanEqual(at, extent))) return;
  vec3 normal = prefiltered_texel_direction(vec2(at.xy) + 0.5, at.z, extent.xy);
  ivec2 parts = ivec2(columns_of_texel, rows_of_texel);
  ivec2 points = parts * textureSize(environment_levels_map, source_level);
  vec3 sum = vec3(0.0);
  for (int y = 0; y < points.y; ++y) {
    float solid_angle = equirectangular_pixel_solid_angle(y, points.x, points.y);
    for (int x = 0; x < points.x; ++x) {
      float cosine = dot(normal, equirectangular_direction((vec2(x, y) + 0.5) / vec2(points)));
      vec3 radiance = texelFetch(environment_levels_map, ivec2(x, y) / parts, source_level).rgb;
#if GRAZING
      cosine *= schlick_weight(cosine);
#endif
      sum += max(cosine, 0.0) * solid_angle * radiance;
    }
  }
  imageStore(irradiance, at, vec4(sum, 1.0));
}
