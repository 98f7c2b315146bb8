// The profile that a program is compiled for. NORMALISED 1: normalised diffusion; 0: the dipole.
#ifndef LIMN_DIFFUSION_PROFILE_GLSL
#define LIMN_DIFFUSION_PROFILE_GLSL
#include "glsl/diffusion/colours.glsl"
LIMN_BEGIN

#if NORMALISED
#define ProfileColours NormalisedColours
#define profile_colours normalised_colours
#else
#define ProfileColours DipoleColours
#define profile_colours dipole_colours
#endif

// C of the dipole of a half space whose albedo, that of a random walk in it, is given by a texture.
LIMN_FN vec3 dipole_reflectance(vec3 albedo, DiffusionBoundary boundary) {
  vec3 absorption = walk_absorption(walk_reflectance(boundary), albedo);
  return vec3(diffusion_dipole(absorption.x, boundary).reflectance, diffusion_dipole(absorption.y, boundary).reflectance,
              diffusion_dipole(absorption.z, boundary).reflectance);
}

// C of the program's profile. Normalised diffusion reflects the albedo itself.
LIMN_FN vec3 profile_reflectance(vec3 albedo, DiffusionBoundary boundary) {
  return NORMALISED != 0 ? albedo : dipole_reflectance(albedo, boundary);
}

LIMN_END
#endif  // LIMN_DIFFUSION_PROFILE_GLSL
