// Reflective shadow maps (Dachsbacher and Stamminger 2005, Reflective Shadow Maps): what reflects light, as the light sees
// it. Beside the depth of a shadow map (glsl/shadow/shadow_view.glsl) a texel holds the geometric normal on the light's side
// (RG16_SNORM, octahedral) and the diffuse albedo for light from there (RGB10_A2, its square root), or the draw instance where
// nobody asks what is reflected. The flux that a texel reflects follows: albedo times what the light sends
// (reflective_map_intensity) times the texel's measure (reflective_map_measure).
//
// A light with extent counts as `samples` points on it, each with its own maps and its share of the light. What a texel
// gets from a rectangle, distant or not, is exact however wide it is, as long as the whole of it is seen where one of its points
// is.
#ifndef LIMN_REFLECTIVE_MAP_GLSL
#define LIMN_REFLECTIVE_MAP_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/scene/light.glsl"
#include "glsl/light/light_intensity.glsl"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/shadow/shadow_view.glsl"
LIMN_BEGIN

// Measure per unit of map area at uv: solid angle, sr (perspective), or area across the light, m^2 (orthographic). A map's
// area is that of the unit square. Perspective: the plane at distance 1 has the area 1 / s^2, and a part of it seen at
// angle theta to the view's axis the solid angle cos^3(theta) per area.
LIMN_FN float reflective_map_measure(ShadowView view, vec2 uv) {
  float s = view.scale;
  float area = 1.0f / (s * s);
  if (view.projection == shadow_orthographic) return area;
  float x = (uv.x - view.middle.x) / s;
  float y = (uv.y - view.middle.y) / s;
  float cosine2 = 1.0f / (1.0f + x * x + y * y);
  return area * cosine2 * sqrt(cosine2);
}

// Below this cosine between a surface and the direction to the point its map is drawn from, texels reflect less than they
// get: their area goes to infinity there.
LIMN_CONST float reflective_map_least_cosine = 0.02f;

// Whether what the light gives is exact: rectangles, but distant ones that are reflected as if all of them came from their centres.
LIMN_FN bool reflective_map_is_rectangle(Light light) {
  return light.type == light_rectangle || (light_is_distant_rectangle(light) && (light.flags & light_flag_centre) == 0u);
}

// Intensity, W/sr, that a rectangle, or one of `samples` points on it, would need as a point to give the surface at p with unit
// normal n what it gives; of a distant one W/m^2 on a perpendicular surface. towards: from p to the point; distant: unit.
LIMN_FN vec3 reflective_map_rectangle_intensity(Light light, vec3 towards, vec3 p, vec3 n, int samples) {
  if (!rectangle_emits_towards(light, p)) return vec3(0.0f);
  float d2 = dot(towards, towards);
  float cosine = dot(n, towards) / max(sqrt(d2), 1e-30f);
  float irradiance = rectangle_irradiance(rectangle_from(light, p), n);
  float share = receiver_factor(light, p) / float(samples);
  return rectangle_radiance(light) * (share * irradiance * d2 / max(cosine, reflective_map_least_cosine));
}

// What a light that is no rectangle, or one of `samples` points on it, sends towards the surface point p: W/sr, or W/m^2 on
// a perpendicular surface (directional). Points on a disc have what passes a place between them; what surfaces get of it follows
// from the directions of them all.
LIMN_FN vec3 reflective_map_intensity(Light light, vec3 p, int samples) {
  float share = light_has_extent(light) ? 1.0f / float(samples) : 1.0f;
  if (samples > 1) share *= light_fluence(light);
  return light.emission * (share * receiver_factor(light, p));
}

LIMN_END
#endif  // LIMN_REFLECTIVE_MAP_GLSL
