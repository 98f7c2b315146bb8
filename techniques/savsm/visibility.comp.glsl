// Soft shadows from a summed-area variance shadow map (Lauritzen 2007): the mean blocker depth from point samples, the
// share of light from Chebyshev's inequality over the whole penumbra kernel.
//
// PATTERN, SEARCH: see glsl/shadow/blocker_samples.glsl. TABLE_FORMAT: sat_format.
#include "glsl/shadow/filter_samples.glsl"
#include "glsl/shadow/summed_area_table.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform usampler2DArray shadow_table;

const uint table_format = TABLE_FORMAT;
const float least_filter_width = 1.0;  // texels: bilinear at least

// P(z >= d) over the kernel, d the receiver's depth at its centre, or at the map's edge where the centre lies outside. Kernels
// with E(z) >= d count as lit, whatever they hold: the "non-planarity" artefact.
float kernel_light(ShadowCursor cursor, ShadowKernel kernel) {
  vec2 centre = 0.5 * (kernel.low + kernel.high);
  vec2 half_extent = 0.5 * (kernel.high - kernel.low);
  float d = map_threshold(cursor.view, cursor.in_map, clamp(centre, vec2(0.0), vec2(cursor.view.size)));
  vec2 m = sat_lookup_moments(shadow_table, centre - half_extent, centre + half_extent, int(cursor.layer), d, table_format);
  float quantum = 1.0 / float(sat_scale(table_format));
  return m.x <= quantum ? 1.0 : clamp(1.0 - m.x * m.x / (m.y + quantum * quantum / 12.0), 0.0, 1.0);
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  float gap = blocker_gap(cursor, q, pixel_noise(uint(pixel.x), uint(pixel.y), 0u));
  if (gap <= 0.0) return 1.0;
  // From beneath the tangent plane no one depth parts what blocks from the rest, as Chebyshev's inequality asks: texels tell.
  if (map_from_beneath(cursor.view, cursor.in_map))
    return samples_lit(cursor, q, gap, blocker_samples, pixel_noise(uint(pixel.x), uint(pixel.y), 1u).xy);
  float lit = 0.0;
  float weights = 0.0;
  uint face = 0u;
  do {
    ShadowKernel kernel;
    if (shadow_kernel_in_face(cursor, q, face, gap, least_filter_width, kernel)) {
      lit += kernel.weight * kernel_light(cursor, kernel);
      weights += kernel.weight;
    }
  } while (++face < shadow_face_count(q.maps.faces));
  return weights > 0.0 ? lit / weights : 1.0;
}
