// The samples of a batch (core/shadow/sample_batches.h): which of them a receiver sees.
#ifndef LIMN_SHADOW_SAMPLES_GLSL
#define LIMN_SHADOW_SAMPLES_GLSL
#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/visibility.glsl"

uniform int first_sample;   // of this batch
uniform int batch_samples;  // in this batch
uniform int total_samples;

// Offset from the receiver to a sample of the light (directional: unit direction).
vec3 sample_offset(VisibilityQuery q, ShadowLight maps) {
  return maps.finite > 0.0 ? maps.origin - q.position : maps.origin;
}

// Whether the map of one sample shows the receiver, which is added to `uncovered` where the map does not hold it. Needs the
// query's position, normal and light axis.
bool sample_visible(VisibilityQuery q, ShadowLight maps, inout uint uncovered) {
  q.maps = maps;
  q.first = view_of_layer(maps.first_layer);
  ShadowCursor cursor = shadow_cursor(q);
  vec2 place = shadow_place(cursor, q.position);
  uncovered += map_holds(cursor.view, place) ? 0u : 1u;
  return !shadow_tap_at(cursor, place).blocked;
}

// Once for all samples of a pixel: atomic additions inside the loop would cost more than the maps.
void count_uncovered(uint uncovered) {
  if (uncovered > 0u) atomicAdd(uncovered_pixels, uncovered);
}

#endif  // LIMN_SHADOW_SAMPLES_GLSL
