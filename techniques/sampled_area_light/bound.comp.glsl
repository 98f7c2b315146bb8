// The bound of sampled area lights: plain accumulation of the maps of a batch (Haeberli and Akeley 1990). For each map a
// matrix, one texel, one comparison of depths and one addition. Every sample counts, above the tangent plane or below it.
#include "glsl/shadow/plain_map.glsl"

#if SAMPLES_FIRST
layout(r16) writeonly uniform image2DArray visibility;
#else
layout(r16) uniform image2DArray visibility;
#endif

uniform int first_sample;   // of this batch
uniform int batch_samples;  // in this batch
uniform int total_samples;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, light_layer());
  VisibilityQuery q = visibility_query(at.xy, uint(at.z * batch_samples));
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  int lit = first_sample == 0 ? total_samples : 0;
  if (!q.masked) {
    lit = 0;
    for (int s = 0; s < batch_samples; ++s) {
      uint layer = q.maps.first_layer + uint(s);  // one view for each sample
      if (plain_map_lit(view_of_layer(layer), layer, q.position)) ++lit;
    }
  }
#if !SAMPLES_FIRST
  lit += int(imageLoad(visibility, at).r * float(total_samples) + 0.5);
#endif
  imageStore(visibility, at, vec4(float(lit) / float(total_samples)));
}
