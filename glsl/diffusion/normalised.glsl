// Normalised diffusion: two exponentials in place of the dipole, with the whole reflectance of a random walk (Christensen and
// Burley 2015, Approximate Reflectance Profiles for Efficient Subsurface Scattering), and that reflectance as a formula. Lengths
// and `absorption` are those of glsl/diffusion/dipole.glsl.
#ifndef LIMN_DIFFUSION_NORMALISED_GLSL
#define LIMN_DIFFUSION_NORMALISED_GLSL
#include "glsl/diffusion/boundary.glsl"
#include "glsl/numeric/exp_log.glsl"
LIMN_BEGIN

// The walk's reflectance is (1 - s) (1 + bend s) / (1 + fall s + drop s^2), s = sqrt(absorption).
struct WalkReflectance {
  float bend;
  float fall;
  float drop;
};

// Bend and drop are fitted; fall gives the exact slope at s = 0, where 1 - A = (4 / sqrt 3) s / (1 - F_dr).
LIMN_FN WalkReflectance walk_reflectance(DiffusionBoundary boundary) {
  WalkReflectance w;
  float inner = 1.0f / boundary.trapping;
  w.bend = 0.14464f + inner * (1.26232f - 1.34592f * inner);
  w.fall = w.bend - 1.0f + 2.3094011f * boundary.trapping;
  w.drop = 0.93985f + 2.73401f * boundary.trapping - 3.43306f * inner;
  return w;
}

// A: of diffuse light that enters a half space of isotropic scattering, the share that leaves. Within 6e-4 of the walk for
// indices from 1 to 3; exactly 1 without absorption and 0 without scattering.
LIMN_FN float walk_albedo(WalkReflectance w, float absorption) {
  float s = sqrt(clamp(absorption, 0.0f, 1.0f));
  return (1.0f - s) * (1.0f + w.bend * s) / (1.0f + s * (w.fall + w.drop * s));
}

// Its inverse: the absorption, 1 - a', of a material that reflects the share `albedo`, in [0, 1].
LIMN_FN float walk_absorption(WalkReflectance w, float albedo) {
  float a = clamp(albedo, 0.0f, 1.0f);
  float linear = 1.0f - w.bend + a * w.fall;
  float square = w.bend + a * w.drop;
  float s = 2.0f * (1.0f - a) / (linear + sqrt(linear * linear + 4.0f * square * (1.0f - a)));
  return min(s * s, 1.0f);
}
LIMN_FN vec3 walk_absorption(WalkReflectance w, vec3 albedo) {
  return vec3(walk_absorption(w, albedo.x), walk_absorption(w, albedo.y), walk_absorption(w, albedo.z));
}

struct NormalisedDiffusion {
  float reflectance;  // A, 0 to 1
  float width;        // d, in mean free paths
};

// At absorptions below 1e-4 the width is that of 1e-4: the light of still whiter materials does not follow the exponentials.
LIMN_FN NormalisedDiffusion normalised_diffusion(float absorption, WalkReflectance walk) {
  NormalisedDiffusion n;
  n.reflectance = walk_albedo(walk, absorption);
  float off = n.reflectance - 0.33f;
  float narrowing = 3.5f + 100.0f * off * off * off * off;
  n.width = 1.0f / (sqrt(3.0f * clamp(absorption, 1e-4f, 1.0f)) * narrowing);
  return n;
}

// Density per area of the radii of normalised_diffusion_radius; r > 0, towards which it grows as 1 / r.
LIMN_FN float normalised_diffusion_density(NormalisedDiffusion n, float r) {
  float x = r / n.width;
  return 0.125f * inverse_pi * (exp(-x) + exp(-x / 3.0f)) / (n.width * r);
}

// The radiosity at distance r for a flux of 1 that enters.
LIMN_FN float normalised_diffusion_profile(NormalisedDiffusion n, float r) {
  return n.reflectance * normalised_diffusion_density(n, r);
}

// Share of the light that leaves within r.
LIMN_FN float normalised_diffusion_share(NormalisedDiffusion n, float r) {
  float x = r / n.width;
  return -0.25f * exp_minus_one(-x) - 0.75f * exp_minus_one(-x / 3.0f);
}

// The radius within which the share xi, in [0, 1), leaves: t = e^(-r / 3d) is the root 2 sinh(asinh(2 (1 - xi)) / 3) of
// t^3 + 3 t = 4 (1 - xi), to which Newton's steps fall from a third of the right side. The last step is in 1 - t, so that small
// radii keep their digits.
LIMN_FN float normalised_diffusion_radius(NormalisedDiffusion n, float xi) {
  float part = min(xi, 0.99999994f);
  float goal = 4.0f * (1.0f - part);
  float t = goal / 3.0f;
  for (int i = 0; i < 4; ++i) t = (2.0f * t * t * t + goal) / (3.0f * t * t + 3.0f);
  float below = max(1.0f - t, 0.0f);
  below -= (below * (6.0f + below * (below - 3.0f)) - 4.0f * part) / (6.0f + below * (3.0f * below - 6.0f));
  return -3.0f * n.width * (below < 0.5f ? log_one_plus(-below) : log(t));
}

LIMN_END
#endif  // LIMN_DIFFUSION_NORMALISED_GLSL
