// Parts of an area light, each a light of its own: what a shadow map from its centre shows hides less of it that the centre
// does not see than one map of the whole light. Parts are of equal area, and of a directional light's disc, of equal solid
// angle.
#ifndef LIMN_LIGHT_PART_GLSL
#define LIMN_LIGHT_PART_GLSL
#include "glsl/light/light_view.glsl"
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Sides of a rectangle, distant or not, of the size that light_view_of_kind() gives it.
LIMN_FN vec2 light_sides(Light light, uint kind, float size) {
  if (size < 0.0f) return vec2(light.length_u, light.length_v);
  return vec2(kind == light_kind_distant_rectangle ? 2.0f * tan(min(0.5f * size, 1.5f)) : size);
}

// Part `part` of the count.x x count.y parts of a light with extent, row by row. size: as light_view_of_kind() takes it; the
// part has its own sides and is to be seen with size -1. Cone and range stay with the whole light: they ask for its centre.
LIMN_FN Light light_part(Light light, uint kind, float size, uvec2 count, uint part) {
  Light p = light;
  vec2 place = vec2((float(part % count.x) + 0.5f) / float(count.x), (float(part / count.x) + 0.5f) / float(count.y));
  p.flags &= ~light_flag_cone;
  p.range = 0.0f;
  if (kind == light_kind_disc) {
    // Discs in place of the cells of a square. Centred on them they would cover less than the disc: they move out to where
    // the mean square of their distance to its centre, its own included, is the disc's.
    LightView whole = light_view_of_kind(light, kind, vec3(0.0f), -light.direction, size);
    float n = float(count.x);
    float even = count.x % 2u == 0u ? 1.0f : 0.0f;
    float spread2 = (n * n - even) / max(n * n - 1.0f - even, 1.0f);
    vec2 disc = sample_disc(place);
    float scale = 0.5f * light_view_cone_scale(whole, min(spread2 * dot(disc, disc), 1.0f)) * sqrt(spread2);
    p.direction = -normalize(whole.centre + scale * (disc.x * whole.side_u + disc.y * whole.side_v));
    p.axis_u = vec3(0.0f);
    p.axis_v = vec3(0.0f);
    p.angular_diameter = 4.0f * arc_sine(sqrt(0.5f * whole.cap) / n);
    return p;
  }
  vec2 sides = light_sides(light, kind, size);
  vec2 from_centre = (place - vec2(0.5f)) * sides;
  p.position = light.position + from_centre.x * light.axis_u + from_centre.y * light.axis_v;
  p.length_u = sides.x / float(count.x);
  p.length_v = sides.y / float(count.y);
  if (kind == light_kind_distant_rectangle) p.direction = -normalize(p.position);
  return p;
}

// The share of a light with extent that lies above the receiver's tangent plane: of a rectangle's area, of a disc as if it
// were flat.
LIMN_FN float light_view_share(LightView v) {
  if (v.whole) return 1.0f;
  if (v.masked) return 0.0f;
  float height = dot(v.centre, v.normal);
  if (v.cone) {
    float h = clamp(height / sqrt(v.cap * (2.0f - v.cap)), -1.0f, 1.0f);
    return 0.5f + (arc_sine(h) + h * sqrt(1.0f - h * h)) * inverse_pi;
  }
  // The sum of two uniform variables, of which `a` reaches farther, is greater than -height.
  float u = 0.5f * abs(dot(v.side_u, v.normal));
  float w = 0.5f * abs(dot(v.side_v, v.normal));
  float a = max(u, w);
  float b = min(u, w);
  float t = abs(height);
  float rest = max(a + b - t, 0.0f);
  float less = t < a - b ? 0.5f - 0.5f * t / a : rest * rest / max(8.0f * a * b, 1e-37f);
  return clamp(height < 0.0f ? less : 1.0f - less, 0.0f, 1.0f);
}

// How much of the box around the counted part (LightView::low, high) lies above the tangent plane; of a rectangle, half or
// more.
LIMN_FN float light_view_box_share(LightView v) {
  vec2 box = v.high - v.low;
  return clamp(light_view_share(v) / max(box.x * box.y, 1e-20f), v.cone ? 1e-3f : 0.5f, 1.0f);
}

LIMN_END
#endif  // LIMN_LIGHT_PART_GLSL
