// What leaves at a place of a body for light that enters at another, by the profile of glsl/diffusion/profile.glsl.
#ifndef LIMN_SCATTER_MATTER_GLSL
#define LIMN_SCATTER_MATTER_GLSL
#include "glsl/diffusion/profile.glsl"
#include "techniques/hierarchical_subsurface/scatter_tree.glsl"
LIMN_BEGIN

// Per radius of the body. albedo: of the half space, where the body is textured.
LIMN_FN ProfileColours scatter_matter(ScatterBody body, DiffusionBoundary boundary, vec3 albedo) {
  vec3 absorption = body.absorption;
  if (body.textured != 0u) absorption = walk_absorption(walk_reflectance(boundary), albedo);
  return profile_colours(body.extinction * body.radius, absorption, boundary);
}

// Points that are farther apart than light goes cannot say where it is. Distances r to them become sqrt(r^2 + h^2), with h the
// body's softening: the sum over points is then smooth, and on a plane it lacks exactly the light that leaves within h of where
// it entered (substitute s^2 = r^2 + h^2, s ds = r dr). That part comes from the light that enters at the place itself.
LIMN_FN vec3 scatter_far(ProfileColours m, float softened) { return m.reflectance * diffusion_density(m, softened); }
LIMN_FN vec3 scatter_near(ProfileColours m, float softening) {
  return m.reflectance * vec3(diffusion_share(m, 0, softening), diffusion_share(m, 1, softening), diffusion_share(m, 2, softening));
}

LIMN_END
#endif  // LIMN_SCATTER_MATTER_GLSL
