// V as the lit share of the samples above the receiver's tangent plane. Each batch adds its part.
#include "glsl/shadow/shadow_samples.glsl"

#if ACCUMULATE
layout(r16) uniform image2DArray visibility;
#else
layout(r16) writeonly uniform image2DArray visibility;
#endif

// How many of all samples count: every batch needs the same number.
int samples_above(VisibilityQuery q) {
  if (q.light.whole) return total_samples;
  int above = 0;
  for (int i = 0; i < total_samples; ++i) {
    vec2 u = fract(r2_sequence(uint(i)) + 0.5);
    vec3 offset = light_view_point(q.light, u);
    if (dot(offset, q.normal) > 0.0) ++above;
  }
  return above;
}

float batch_share(VisibilityQuery q, int layer, inout uint uncovered) {
  if (!q.light.extended) return first_sample == 0 && sample_visible(q, q.maps, uncovered) ? 1.0 : 0.0;
  int above = samples_above(q);
  if (above == 0) return first_sample == 0 ? 1.0 : 0.0;
  int lit = 0;
  for (int s = 0; s < batch_samples; ++s) {
    ShadowLight maps = maps_at(uint(layer * batch_samples + s));
    bool above_plane = dot(sample_offset(q, maps), q.normal) > 0.0;
    lit += above_plane && sample_visible(q, maps, uncovered) ? 1 : 0;
  }
  return float(lit) / float(above);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, light_layer());
  VisibilityQuery q = visibility_query(at.xy, uint(at.z * batch_samples));
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  float v = first_sample == 0 ? 1.0 : 0.0;
  uint uncovered = 0u;
  if (!q.masked) v = batch_share(q, at.z, uncovered);
  count_uncovered(uncovered);
#if ACCUMULATE
  v += imageLoad(visibility, at).r;
#endif
  imageStore(visibility, at, vec4(v));
}
