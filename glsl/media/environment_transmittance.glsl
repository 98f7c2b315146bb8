// What the medium leaves of the environment's light on its way to a surface, as passes read it that bind the frame block. What
// coats mirror comes from the mirror direction; all other light counts as coming along the normal.
#ifndef LIMN_ENVIRONMENT_TRANSMITTANCE_GLSL
#define LIMN_ENVIRONMENT_TRANSMITTANCE_GLSL
#include "glsl/media/medium_input.glsl"
#include "glsl/numeric/geometry.glsl"
#include "glsl/surface/reflected_parts.glsl"

// coated: the lobe is what a coat mirrors. n: shading normal; v: unit, to the viewer.
ReflectedParts environment_through_medium(ReflectedParts light, bool coated, vec3 position, vec3 n, vec3 v) {
  Medium medium = scene_medium();
  vec3 left = medium_transmittance(medium, medium_length(medium, position, n, 3.0e38));
  light.diffuse *= left;
  if (coated) left = medium_transmittance(medium, medium_length(medium, position, mirror_direction(n, v), 3.0e38));
  light.lobe *= left;
  return light;
}

#endif  // LIMN_ENVIRONMENT_TRANSMITTANCE_GLSL
