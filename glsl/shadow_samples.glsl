// The samples of a batch (core/shadow/sample_batches.h): which of them a receiver sees.
#ifndef LIMN_SHADOW_SAMPLES_GLSL
#define LIMN_SHADOW_SAMPLES_GLSL
#include "glsl/sampling.glsl"
#include "glsl/visibility.glsl"

uniform int first_sample;   // of this batch
uniform int batch_samples;  // in this batch
uniform int total_samples;

// Offset from the receiver to a sample of the light (directional: unit direction).
vec3 sample_offset(VisibilityQuery q, ShadowLight maps) {
  return maps.origin.w > 0.0 ? maps.origin.xyz - q.position : maps.origin.xyz;
}

// Whether the map of one sample shows the receiver. Needs the query's position, normal and light axis.
bool sample_visible(inout VisibilityQuery q, ShadowLight maps) {
  q.maps = maps;
  q.first = shadow_views[maps.info.x];
  ShadowCursor cursor = shadow_cursor(q);
  return !shadow_covers_receiver(cursor, q) || !shadow_tap(cursor, q, q.position).blocked;
}

#endif  // LIMN_SHADOW_SAMPLES_GLSL
