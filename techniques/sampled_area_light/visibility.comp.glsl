// V as the lit share of the samples above the receiver's tangent plane. A batch hands on how many are lit as a share of all
// samples: of up to 4096 of them 16 bits tell the number exactly. SAMPLES_FIRST, SAMPLES_LAST: no batch is before this one, or
// after.
#include "glsl/shadow/shadow_samples.glsl"

#if SAMPLES_FIRST
layout(r16) writeonly uniform image2DArray visibility;
#else
layout(r16) uniform image2DArray visibility;
#endif

// Of this batch; all samples of the first one where there is one answer for them.
int lit_samples(VisibilityQuery q, int layer, inout uint uncovered) {
  if (q.masked) return first_sample == 0 ? total_samples : 0;
  if (!q.light.extended) return first_sample == 0 && sample_visible(q, q.maps, uncovered) ? total_samples : 0;
  int lit = 0;
  for (int s = 0; s < batch_samples; ++s) {
    ShadowLight maps = maps_at(uint(layer * batch_samples + s));
    bool above_plane = dot(sample_offset(q, maps), q.normal) > 0.0;
    lit += above_plane && sample_visible(q, maps, uncovered) ? 1 : 0;
  }
  return lit;
}

#if SAMPLES_LAST
// How many of all samples count.
int samples_above(VisibilityQuery q) {
  if (q.masked || q.light.whole || !q.light.extended) return total_samples;
  int above = 0;
  for (int i = 0; i < total_samples; ++i) {
    vec3 offset = light_view_point(q.light, r2_point(uint(i), uint(total_samples)));
    if (dot(offset, q.normal) > 0.0) ++above;
  }
  return above;
}
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, light_layer());
  VisibilityQuery q = visibility_query(at.xy, uint(at.z * batch_samples));
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  uint uncovered = 0u;
  int lit = lit_samples(q, at.z, uncovered);
  count_uncovered(uncovered);
#if !SAMPLES_FIRST
  lit += int(imageLoad(visibility, at).r * float(total_samples) + 0.5);
#endif
#if SAMPLES_LAST
  int all = samples_above(q);
#else
  int all = total_samples;
#endif
  imageStore(visibility, at, vec4(all > 0 ? float(lit) / float(all) : 1.0));
}
