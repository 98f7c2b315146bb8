// What the medium leaves of a light on its way to a surface, as passes read it that bind the frame block. MEDIUM 1: the scene has a
// medium, which core/gpu_scene/gpu_medium.h declares; 0: nothing is taken of any light.
#ifndef LIMN_LIGHT_TRANSMITTANCE_GLSL
#define LIMN_LIGHT_TRANSMITTANCE_GLSL
#include "glsl/scene/light.glsl"
#if MEDIUM
#include "glsl/media/medium_input.glsl"
#endif

// T_l: from a light's centre to a surface point.
vec3 light_transmittance(Light light, vec3 position) {
#if MEDIUM
  Medium medium = scene_medium();
  float inside = light.type == light_directional
                     ? medium_length(medium, position, -light.direction, 3.0e38)
                     : medium_length_between(medium, light.position, position);
  return medium_transmittance(medium, inside);
#else
  return vec3(1.0);
#endif
}

#endif  // LIMN_LIGHT_TRANSMITTANCE_GLSL
