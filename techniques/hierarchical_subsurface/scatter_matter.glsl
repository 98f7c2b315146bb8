// What leaves at a place of a body for light that enters at another. NORMALISED_DIFFUSION 1: by normalised diffusion; 0: by the
// dipole.
#ifndef LIMN_SCATTER_MATTER_GLSL
#define LIMN_SCATTER_MATTER_GLSL
#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
#include "techniques/hierarchical_subsurface/scatter_tree.glsl"
LIMN_BEGIN

// One channel's radiosity at r (mean free paths, more than 0) for a flux of 1 that enters, and the radiosity of entering light
// of 1 over all places within r of a plane.
LIMN_FN float scatter_profile(DiffusionDipole d, float r) { return diffusion_dipole_profile(d, r); }
LIMN_FN float scatter_profile(NormalisedDiffusion n, float r) { return normalised_diffusion_profile(n, r); }
LIMN_FN float scatter_within(DiffusionDipole d, float r) { return d.reflectance * diffusion_dipole_share(d, r); }
LIMN_FN float scatter_within(NormalisedDiffusion n, float r) {
  return n.reflectance * normalised_diffusion_share(n, r);
}

#if NORMALISED_DIFFUSION
#define ScatterProfile NormalisedDiffusion
#else
#define ScatterProfile DiffusionDipole
#endif

struct ScatterMatter {
  ScatterProfile red;
  ScatterProfile green;
  ScatterProfile blue;
  vec3 extinction;  // sigma_t', per radius of the body
};

// albedo: of the half space, where the body is textured.
LIMN_FN ScatterMatter scatter_matter(ScatterBody body, DiffusionBoundary boundary, vec3 albedo) {
  WalkReflectance walk = walk_reflectance(boundary);
  vec3 absorption = body.absorption;
  if (body.textured != 0u)
    absorption = vec3(walk_absorption(walk, albedo.x), walk_absorption(walk, albedo.y), walk_absorption(walk, albedo.z));
  ScatterMatter m;
#if NORMALISED_DIFFUSION
  m.red = normalised_diffusion(absorption.x, walk);
  m.green = normalised_diffusion(absorption.y, walk);
  m.blue = normalised_diffusion(absorption.z, walk);
#else
  m.red = diffusion_dipole(absorption.x, boundary);
  m.green = diffusion_dipole(absorption.y, boundary);
  m.blue = diffusion_dipole(absorption.z, boundary);
#endif
  m.extinction = body.extinction * body.radius;
  return m;
}

// Points that are farther apart than light goes cannot say where it is. Distances r to them become sqrt(r^2 + h^2), with h the
// body's softening: the sum over points is then smooth, and on a plane it lacks exactly the light that leaves within h of where
// it entered (substitute s^2 = r^2 + h^2, s ds = r dr). That part comes from the light that enters at the place itself.
LIMN_FN vec3 scatter_far(ScatterMatter m, float softened) {
  vec3 r = softened * m.extinction;
  return m.extinction * m.extinction *
         vec3(scatter_profile(m.red, r.x), scatter_profile(m.green, r.y), scatter_profile(m.blue, r.z));
}
LIMN_FN vec3 scatter_near(ScatterMatter m, float softening) {
  vec3 r = min(softening * m.extinction, vec3(1e10f));
  return vec3(scatter_within(m.red, r.x), scatter_within(m.green, r.y), scatter_within(m.blue, r.z));
}

LIMN_END
#endif  // LIMN_SCATTER_MATTER_GLSL
