// The table of lobes of microfacets: see microfacet_lobe().
#include "glsl/light/prefiltered_models.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2D lobes;

const int samples = 1024;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(lobes);
  if (any(greaterThanEqual(at, size))) return;
  vec2 place = vec2(at) / vec2(size - 1);
  MicrofacetLobe lobe =
      microfacet_lobe(place.x * place.x, environment_alpha(place.y * float(environment_levels - 1)), samples);
  imageStore(lobes, at, vec4(lobe.reflectance, lobe.cosine, lobe.tilt, lobe.widening));
}
