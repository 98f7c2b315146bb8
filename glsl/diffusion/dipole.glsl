// Light that leaves a half space at distance r from where it entered, by the dipole of sources (Jensen, Marschner, Levoy and
// Hanrahan 2001, A Practical Model for Subsurface Light Transport). Lengths are in reduced mean free paths, 1 / sigma_t'; per
// square metre a profile is sigma_t'^2 times what stands here, at r sigma_t'. `absorption` is sigma_a / sigma_t', 1 - a', in
// [0, 1], which keeps its digits where a' is nearly 1.
#ifndef LIMN_DIFFUSION_DIPOLE_GLSL
#define LIMN_DIFFUSION_DIPOLE_GLSL
#include "glsl/diffusion/boundary.glsl"
#include "glsl/numeric/exp_log.glsl"
LIMN_BEGIN

// The real source lies one mean free path below the surface, the virtual one above it.
struct DiffusionDipole {
  float decay;           // sigma: of the fluence, per mean free path, 0 to sqrt(3)
  float virtual_height;  // z_v
  float real_share;      // of all light that leaves, 0.5 to 1
  float reflectance;     // C: of all light that enters, what leaves, 0 to 1
};

LIMN_FN DiffusionDipole diffusion_dipole(float absorption, DiffusionBoundary boundary) {
  DiffusionDipole d;
  float absorbed = clamp(absorption, 0.0f, 1.0f);
  d.decay = sqrt(3.0f * absorbed);
  d.virtual_height = 1.0f + 1.3333333f * diffusion_mismatch(boundary);
  float real = exp(-d.decay);
  float both = real + exp(-d.decay * d.virtual_height);
  d.real_share = real / both;
  d.reflectance = 0.5f * (1.0f - absorbed) * both;
  return d;
}

// Share of one source's light per area at distance r. Its integral over the plane is 1.
LIMN_FN float diffusion_source_density(float z, float decay, float r) {
  float s = sqrt(r * r + z * z);
  return 0.5f * inverse_pi * z * (1.0f + decay * s) * exp(-decay * (s - z)) / (s * s * s);
}

// Density per area of the radii of diffusion_dipole_radius, Rd / C; defined for a' = 0, too. r >= 0; beyond 1e10 it is that there.
LIMN_FN float diffusion_dipole_density(DiffusionDipole d, float r) {
  float reach = min(r, 1e10f);
  return d.real_share * diffusion_source_density(1.0f, d.decay, reach) +
         (1.0f - d.real_share) * diffusion_source_density(d.virtual_height, d.decay, reach);
}

// Rd: the radiosity at distance r for a flux of 1 that enters.
LIMN_FN float diffusion_dipole_profile(DiffusionDipole d, float r) {
  return d.reflectance * diffusion_dipole_density(d, r);
}

// Share of the light that leaves within r.
LIMN_FN float diffusion_source_share(float z, float decay, float r) {
  float w = r / z;
  float rise = w * w / (sqrt(1.0f + w * w) + 1.0f);  // s / z - 1
  return -exp_minus_one(-decay * z * rise - log_one_plus(rise));
}
LIMN_FN float diffusion_dipole_share(DiffusionDipole d, float r) {
  return d.real_share * diffusion_source_share(1.0f, d.decay, r) +
         (1.0f - d.real_share) * diffusion_source_share(d.virtual_height, d.decay, r);
}

// The radius within which the share xi, in [0, 1), of one source's light leaves. With y = ln(s / z) and a = decay z it solves
// a (e^y - 1) + y = -ln(1 - xi); the left side is convex and Newton's steps start to the right of the root, so that they fall to
// it monotonically. Within 1.4e-6 of its value for a in [0, 20].
LIMN_FN float diffusion_source_radius(float z, float decay, float xi) {
  float a = decay * z;
  float goal = -log_one_plus(-min(xi, 0.99999994f));
  float y = min(goal, log_one_plus(goal / max(a, 1e-20f)));
  for (int i = 0; i < 5; ++i) {
    float rise = exp_minus_one(y);
    y -= (a * rise + y - goal) / (a * rise + a + 1.0f);
  }
  float rise = exp_minus_one(max(y, 0.0f));
  return z * sqrt(rise * (rise + 2.0f));
}

// A radius with diffusion_dipole_density from xi uniform in [0, 1), which chooses the source and is then stretched.
LIMN_FN float diffusion_dipole_radius(DiffusionDipole d, float xi) {
  bool real = xi < d.real_share;
  float rest = real ? xi / d.real_share : (xi - d.real_share) / (1.0f - d.real_share);
  return diffusion_source_radius(real ? 1.0f : d.virtual_height, d.decay, rest);
}

LIMN_END
#endif  // LIMN_DIFFUSION_DIPOLE_GLSL
