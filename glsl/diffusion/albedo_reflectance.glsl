// What a half space reflects whose albedo, that of a random walk in it, is given by a texture.
#ifndef LIMN_ALBEDO_REFLECTANCE_GLSL
#define LIMN_ALBEDO_REFLECTANCE_GLSL
#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
LIMN_BEGIN

// C of the dipole. Normalised diffusion reflects the albedo itself.
LIMN_FN vec3 dipole_reflectance(vec3 albedo, DiffusionBoundary boundary) {
  vec3 absorption = walk_absorption(walk_reflectance(boundary), albedo);
  return vec3(diffusion_dipole(absorption.x, boundary).reflectance, diffusion_dipole(absorption.y, boundary).reflectance,
              diffusion_dipole(absorption.z, boundary).reflectance);
}

LIMN_END
#endif  // LIMN_ALBEDO_REFLECTANCE_GLSL
