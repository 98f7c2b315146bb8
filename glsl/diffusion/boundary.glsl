// The smooth boundary of a body that scatters light below its surface: what it lets in, out and sends back in. eta is the body's
// index of refraction, 1 or more. F_de is the mean reflectance of diffuse light from outside, F_dr of that from inside:
// 1 - F_dr = (1 - F_de) / eta^2, since the same paths go both ways.
#ifndef LIMN_DIFFUSION_BOUNDARY_GLSL
#define LIMN_DIFFUSION_BOUNDARY_GLSL
#include "glsl/materials/fresnel.glsl"
LIMN_BEGIN

struct DiffusionBoundary {
  float eta;
  float entering;  // 1 - F_de
  float trapping;  // 1 / (1 - F_dr), 1 or more
};

// For an index of 1 or more whose 1 - F_de is known.
LIMN_FN DiffusionBoundary diffusion_boundary(float eta, float entering) {
  DiffusionBoundary b;
  b.eta = eta;
  b.entering = entering;
  b.trapping = eta * eta / entering;
  return b;
}

// Exact up to rounding and to the 1e-5 of dielectric_mean_reflectance. The polynomial in eta that is often taken for F_dr makes
// diffusion_mismatch 0.3 % too large at eta = 1 and 26 % at 3.
LIMN_FN DiffusionBoundary diffusion_boundary(float eta) {
  float index = clamp(eta, 1.0f, 3.0f);  // no body that light enters has more
  return diffusion_boundary(index, 1.0f - dielectric_mean_reflectance(index));
}

// A = (1 + F_dr) / (1 - F_dr): the fluence on the boundary is 2 A times the flux that leaves through a unit of its area.
LIMN_FN float diffusion_mismatch(DiffusionBoundary b) { return 2.0f * b.trapping - 1.0f; }

// Share of the light from a direction at this cosine that enters, F_t.
LIMN_FN float diffusion_entry(DiffusionBoundary b, float cosine) { return 1.0f - fresnel(cosine, b.eta, 0.0f); }

// Radiance that leaves at this cosine for a radiosity of 1, 1/sr: F_t / (pi (1 - F_de)), whose integral times the cosine is 1.
LIMN_FN float diffusion_exit(DiffusionBoundary b, float cosine) {
  return inverse_pi * diffusion_entry(b, cosine) / b.entering;
}

LIMN_END
#endif  // LIMN_DIFFUSION_BOUNDARY_GLSL
