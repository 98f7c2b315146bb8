// What a light, or one point of it, sends in a direction: for rays that start there.
#ifndef LIMN_LIGHT_INTENSITY_GLSL
#define LIMN_LIGHT_INTENSITY_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/scene/light.glsl"
LIMN_BEGIN

// What a light, or one of `samples` points on it, at `origin` sends towards p: W/sr, or W/m^2 on a perpendicular surface
// (directional). A rectangle is a Lambertian sender of intensity radiance * area * cosine.
LIMN_FN vec3 light_point_intensity(Light light, vec3 origin, vec3 p, int samples) {
  float share = light_has_extent(light) ? 1.0f / float(samples) : 1.0f;
  vec3 sent = light.emission * (share * receiver_factor(light, p));
  if (light.type != light_rectangle) return sent;
  vec3 towards = p - origin;
  float along = dot(light.direction, towards);
  if ((light.flags & light_flag_two_sided) != 0u) along = abs(along);
  float cosine = max(along, 0.0f) / max(length(towards), 1e-30f);
  return sent * (light.length_u * light.length_v * cosine);
}

// What passes a place of a directional light's disc, whatever its direction, over the irradiance that the disc gives a surface
// that faces it. Its radiance is even: 2 / (1 + cos) of half its diameter. 1 for other lights.
LIMN_FN float light_fluence(Light light) {
  if (light_kind(light) != light_kind_disc) return 1.0f;
  float tangent = tan(min(0.25f * light.angular_diameter, 0.775f));
  return 1.0f + tangent * tangent;
}

LIMN_END
#endif  // LIMN_LIGHT_INTENSITY_GLSL
