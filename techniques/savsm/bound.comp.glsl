// The bound of summed-area variance shadow maps: the texels and the decisions of visibility.comp.glsl. A sample of the search is
// two numbers, and what of the kernel lies outside the map is counted once for all of its parts. One view sees all of the light,
// which is a rectangle.
//
// PATTERN, SEARCH: see glsl/shadow/sample_taps.glsl. TABLE_FORMAT: sat_format.
#include "glsl/shadow/filter_taps.glsl"
#include "glsl/shadow/summed_area_table.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform usampler2DArray shadow_table;

const uint table_format = TABLE_FORMAT;
const float least_filter_width = 1.0;  // texels

uvec4 sums_at(int x, int y, int layer, ivec2 size) { return sat_sums(shadow_table, ivec2(x, y), layer, size, table_format); }

// sat_lookup_moments() of the kernel low..high.
vec2 kernel_moments(vec2 low, vec2 high, int layer, float d) {
  ivec2 size = textureSize(shadow_table, 0).xy;
  ivec2 margin = sat_margin(size, table_format);
  SatAxis across = sat_axis(low.x, high.x, size.x, margin.x);
  SatAxis down = sat_axis(low.y, high.y, size.y, margin.y);
  ivec4 x = clamp(across.edges, ivec4(0), ivec4(size.x));
  ivec4 y = clamp(down.edges, ivec4(0), ivec4(size.y));
  ivec3 columns = x.yzw - x.xyz;
  ivec3 rows = y.yzw - y.xyz;
  uint receiver = sat_quantise(d, table_format);
  SatMoments moments = SatMoments(0.0, 0.0, 0.0);
  uvec4 above[4];
  for (int i = 0; i < 4; ++i) above[i] = sums_at(x[i], y[0], layer, size);
  for (int j = 0; j < 3; ++j) {
    uvec4 left = sums_at(x[0], y[j + 1], layer, size);
    for (int i = 0; i < 3; ++i) {
      uvec4 right = sums_at(x[i + 1], y[j + 1], layer, size);
      SatBox box = sat_box(right, left, above[i + 1], above[i], uint(columns[i] * rows[j]), table_format);
      moments = sat_accumulated(moments, box, across.weights[i] * down.weights[j], receiver, table_format);
      above[i] = left;
      left = right;
    }
    above[3] = left;
  }
  vec2 whole = vec2(dot(across.weights, vec3(across.edges.yzw - across.edges.xyz)),
                    dot(down.weights, vec3(down.edges.yzw - down.edges.xyz)));
  vec2 inside = vec2(dot(across.weights, vec3(columns)), dot(down.weights, vec3(rows)));
  float outside = whole.x * whole.y - inside.x * inside.y;  // unoccluded: depth 1
  float beyond = float(receiver) - float(sat_scale(table_format));
  moments.weight += outside;
  moments.first += outside * beyond;
  moments.second += outside * beyond * beyond;
  return sat_moments(sat_beyond(moments, low, high, size, receiver, table_format), d, receiver, table_format);
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  LightView part = light_view_part(q.light);
  MapKernel rays = map_kernel_across(cursor.view, part, q.position);
  MapTest test = map_test(cursor);
  vec3 rises = light_view_rise(part);
  float gap = mean_gap(cursor, q, test, rays, rises, pixel_noise(uint(pixel.x), uint(pixel.y), 0u));
  if (gap <= 0.0) return 1.0;
  if (map_from_beneath(cursor.view, cursor.in_map))
    return taps_lit(cursor, test, rays, rises, gap, blocker_samples, pixel_noise(uint(pixel.x), uint(pixel.y), 1u).xy);
  ShadowKernel kernel = rays_box(box_rays(cursor.view, rays), gap, least_filter_width);
  vec2 centre = 0.5 * (kernel.low + kernel.high);
  vec2 reach = 0.5 * (kernel.high - kernel.low);
  vec2 place = clamp(centre, vec2(0.0), vec2(cursor.view.size));
  float d = map_test_threshold(test, dot(test.plane, vec3(place - 0.5, 1.0)));
  vec2 m = kernel_moments(centre - reach, centre + reach, int(cursor.layer), d);
  float quantum = 1.0 / float(sat_scale(table_format));
  return m.x <= quantum ? 1.0 : clamp(1.0 - m.x * m.x / (m.y + quantum * quantum / 12.0), 0.0, 1.0);
}
