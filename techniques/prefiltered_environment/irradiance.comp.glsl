// Irradiance of surfaces that face each direction: the sum over all texels of one level of the chain. GRAZING 1: of light
// weighted by Schlick's (1 - cosine)^5.
#include "glsl/light/prefiltered.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2DArray irradiance;
uniform sampler2DArray source;
uniform int source_level;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec3 extent = imageSize(irradiance);
  if (any(greaterThanEqual(at, extent))) return;
  vec3 normal = prefiltered_texel_direction(vec2(at.xy) + 0.5, at.z, extent.y);
  ivec3 texels = textureSize(source, source_level);
  vec3 sum = vec3(0.0);
  for (int layer = 0; layer < texels.z; ++layer) {
    for (int y = 0; y < texels.y; ++y) {
      for (int x = 0; x < texels.x; ++x) {
        vec2 centre = vec2(x, y) + 0.5;
        float cosine = dot(normal, prefiltered_texel_direction(centre, layer, texels.y));
        vec3 radiance = texelFetch(source, ivec3(x, y, layer), source_level).rgb;
#if GRAZING
        cosine *= schlick_weight(cosine);
#endif
        sum += max(cosine, 0.0) * prefiltered_solid_angle(centre, texels.y) * radiance;
      }
    }
  }
  imageStore(irradiance, at, vec4(sum, 1.0));
}
