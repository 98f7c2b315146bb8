// Lights as if all of their light came from their centres.
#ifndef LIMN_LIGHT_CENTRE_GLSL
#define LIMN_LIGHT_CENTRE_GLSL
#include "glsl/light/light_intensity.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/scene/light.glsl"
LIMN_BEGIN

// Unit vector towards a light's centre; 0 where p is the centre.
LIMN_FN vec3 light_centre_direction(Light light, vec3 p) {
  uint kind = light_kind(light);
  vec3 offset = kind == light_kind_disc                ? -light.direction
                : kind == light_kind_distant_rectangle ? light.position
                                                       : light.position - p;
  float size = length(offset);
  return size > 0.0f ? offset / size : vec3(0.0f);
}

// Irradiance (W/m^2) on a surface at p that faces the centre, unoccluded; 0 where p is the centre.
LIMN_FN vec3 light_centre_irradiance(Light light, vec3 p) {
  vec3 sent = light_point_intensity(light, light.position, p, 1);
  if (light.type == light_directional) return sent;
  vec3 offset = light.position - p;
  float distance2 = dot(offset, offset);
  return distance2 > 0.0f ? sent / distance2 : vec3(0.0f);
}

LIMN_END
#endif  // LIMN_LIGHT_CENTRE_GLSL
