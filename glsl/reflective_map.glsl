// Reflective shadow maps (Dachsbacher and Stamminger 2005, Reflective Shadow Maps): what reflects light, as the light sees
// it. Beside the depth of a shadow map (glsl/shadow_view.glsl) a texel holds the geometric normal on the light's side
// (RG16_SNORM, octahedral) and the diffuse albedo for light from there (RGBA8, sRGB-encoded). The flux it reflects follows:
// albedo times what the light sends (reflective_map_intensity) times the texel's measure (reflective_map_measure).
//
// A light with extent counts as `samples` points on it, each with its own maps and its share of the light. The points are
// seen as from afar: the flux of a texel is exact only where the light is small as seen from the surface.
#ifndef LIMN_REFLECTIVE_MAP_GLSL
#define LIMN_REFLECTIVE_MAP_GLSL
#include "glsl/language.glsl"
#include "glsl/light.glsl"
#include "glsl/shadow_view.glsl"
LIMN_BEGIN

// Measure per unit of map area at uv: solid angle, sr (perspective), or area across the light, m^2 (orthographic). A map's
// area is that of the unit square. Perspective: the plane at distance 1 has the area 1 / s^2, and a part of it seen at
// angle theta to the view's axis the solid angle cos^3(theta) per area.
LIMN_FN float reflective_map_measure(ShadowView view, vec2 uv) {
  float s = view.axis_x.w;
  float area = 1.0f / (s * s);
  if (view.info.x == shadow_orthographic) return area;
  float x = (uv.x - 0.5f) / s;
  float y = (uv.y - 0.5f) / s;
  float cosine2 = 1.0f / (1.0f + x * x + y * y);
  return area * cosine2 * sqrt(cosine2);
}

// What a light, or one of `samples` points on it, at `origin` sends towards the surface point p: W/sr, or W/m^2 on a
// perpendicular surface (directional). A rectangle is a Lambertian sender of intensity radiance * area * cosine.
LIMN_FN vec3 reflective_map_intensity(Light light, vec3 origin, vec3 p, int samples) {
  float share = light_has_extent(light) ? 1.0f / float(samples) : 1.0f;
  vec3 sent = vec3(light.emission) * (share * receiver_factor(light, p));
  if (light.info.x != light_rectangle) return sent;
  vec3 towards = p - origin;
  float along = dot(vec3(light.direction), towards);
  if ((light.info.y & light_flag_two_sided) != 0u) along = abs(along);
  float cosine = max(along, 0.0f) / max(length(towards), 1e-30f);
  return sent * (light.axis_u.w * light.axis_v.w * cosine);
}

LIMN_END
#endif  // LIMN_REFLECTIVE_MAP_GLSL
