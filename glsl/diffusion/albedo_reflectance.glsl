// What a half space reflects whose albedo, that of a random walk in it, is given by a texture.
#ifndef LIMN_ALBEDO_REFLECTANCE_GLSL
#define LIMN_ALBEDO_REFLECTANCE_GLSL
#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
LIMN_BEGIN

// C of the dipole. Normalised diffusion reflects the albedo itself.
LIMN_FN vec3 dipole_reflectance(vec3 albedo, DiffusionBoundary boundary) {
  WalkReflectance walk = walk_reflectance(boundary);
  return vec3(diffusion_dipole(walk_absorption(walk, albedo.x), boundary).reflectance,
              diffusion_dipole(walk_absorption(walk, albedo.y), boundary).reflectance,
              diffusion_dipole(walk_absorption(walk, albedo.z), boundary).reflectance);
}

LIMN_END
#endif  // LIMN_ALBEDO_REFLECTANCE_GLSL
