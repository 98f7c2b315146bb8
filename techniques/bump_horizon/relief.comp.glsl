// W of a batch of lights: whether bumps of a pixel's height map hide each light's centre, or which part of the light. One
// layer per light; 1 where the pixel has no height map.
// SHAPE 0: moment ellipses, 1: published fit, 2: horizon map (RELIEF_AZIMUTHS), 3: march, 5: scan,
// 6: ambient visibility alone. SOFT 1: lights have their size.
#include "glsl/light/light_centre.glsl"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/relief/relief_input.glsl"
#include "glsl/relief/relief_maps.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r16) writeonly uniform image2DArray relief;
layout(std430) readonly buffer Lights { Light lights[]; };
uniform uint light_indices[LIGHT_COUNT];
#if SHAPE == 3 || SHAPE == 5
uniform int steps;
#endif

// Sine of a light's angular radius; of rectangles that of the round light with the same solid angle.
float light_radius_sine(Light light, vec3 p) {
  uint kind = light_kind(light);
  if (kind == light_kind_point) return 0.0;
  if (kind == light_kind_disc) return sin(0.5 * light.angular_diameter);
  float height = rectangle_solid_angle(rectangle_from(light, p), rectangle_whole()) / (2.0 * pi);  // of the cap
  return sqrt(max(height * (2.0 - height), 0.0));
}

#if SHAPE <= 1
// The wider of two edges decides: that of the light and that of the texels which a mean was taken of.
float ellipse_part(ReliefEllipse e, vec3 l, float sine) {
  if (sine > 1.7 * e.spread) return ellipse_visibility(e, l, sine);
  return e.spread > 0.0 ? ellipse_mean_visibility(e, l) : (ellipse_lit(e, l) ? 1.0 : 0.0);
}
#endif

#if SHAPE == 3
// Whether no step on the way from the surface above `place` to the highest level lies below it.
bool march_leaves(ReliefField f, vec2 place, float level, vec3 l) {
  if (l.z <= 0.0) return false;
  float rise = f.highest - level;
  vec2 way = vec2(l) * (rise / l.z) / f.spacing;
  bool free = true;
  for (int i = 0; i < steps && free; ++i) {
    float part = (float(i) + 0.5) / float(steps);
    free = relief_height(f, place + part * way) <= level + part * rise;
  }
  return free;
}
#endif

#if SHAPE == 5
// Tangent of the highest elevation that steps over half a tile along l meet (Bavoil, Sainz and Dimitrov 2008).
float scanned_horizon(ReliefField f, vec2 place, float level, vec3 l) {
  float across = length(vec2(l));
  if (across == 0.0) return 0.0;
  float reach = 0.5 * min(float(f.size.x) * f.spacing.x, float(f.size.y) * f.spacing.y);
  vec2 way = vec2(l) * (reach / across) / f.spacing;
  float horizon = 0.0;
  int i = 0;
  do {
    float part = (float(i) + 1.0) / float(steps);
    horizon = max(horizon, (relief_height(f, place + part * way) - level) / (part * reach));
  } while (++i < steps);
  return horizon;
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  PixelRelief here = pixel_relief(pixel);
  if (here.height < 0) {
    for (int i = 0; i < LIGHT_COUNT; ++i) imageStore(relief, ivec3(pixel, i), vec4(1.0));
    return;
  }
  vec3 position = pixel_position(pixel, pixel_depth(pixel));
  ReliefField field = relief_fields[here.height];
#if SHAPE == 0
  ReliefEllipse ellipse = relief_ellipse(field, here.uv, here.level);
#elif SHAPE == 1
  ReliefEllipse ellipse = relief_nearest_ellipse(field, here.uv);
#elif SHAPE == 6
  float ambient = relief_ambient(field, here.uv, here.level);
#else
  vec2 place = relief_place(here.uv, field.size);
#if SHAPE == 2
  ReliefTexels texels = relief_texels(field.size, field.clamped != 0u, place);
#else
  float level = relief_height(field, place);
#endif
#endif
  int i = 0;
  do {  // the condition comes last: software renderers run a loop's body once more where it comes first
    Light light = lights[light_indices[i]];
    vec3 l = to_local(here.frame, light_centre_direction(light, position));
#if SHAPE <= 1
#if SOFT
    float w = ellipse_part(ellipse, l, light_radius_sine(light, position));
#else
    float w = ellipse_part(ellipse, l, 0.0);
#endif
#elif SHAPE == 2
    float w = horizon_lit(l, relief_horizon(field, texels, l)) ? 1.0 : 0.0;
#elif SHAPE == 5
    float w = horizon_lit(l, scanned_horizon(field, place, level, l)) ? 1.0 : 0.0;
#elif SHAPE == 6
    float w = l.z > 0.0 ? ambient : 0.0;
#else
    float w = march_leaves(field, place, level, l) ? 1.0 : 0.0;
#endif
    imageStore(relief, ivec3(pixel, i), vec4(w));
  } while (++i < LIGHT_COUNT);
}
