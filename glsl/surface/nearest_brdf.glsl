// The metallic-roughness surface that comes next to one with a model, for light that only such surfaces are prefiltered for.
#ifndef LIMN_NEAREST_BRDF_GLSL
#define LIMN_NEAREST_BRDF_GLSL
#include "glsl/materials/model.glsl"
#include "glsl/surface/reflectance.glsl"
LIMN_BEGIN

// The model's diffuse part, and a lobe of the width alpha that reflects the rest of its albedo. Reflecting all light at grazing
// angles alone makes an albedo of 1/21, so that weak lobes reflect less there: below 2 % head-on f90 is 50 f0 (Lagarde and de
// Rousiers 2014, Moving Frostbite to Physically Based Rendering), which is 15 times the albedo f0 + (f90 - f0) / 21.
LIMN_FN SurfaceBrdf nearest_brdf(MaterialModel m, float alpha) {
  SurfaceBrdf s;
  s.diffuse = model_diffuse_albedo(m);
  s.alpha = alpha;
  vec3 rest = max(model_albedo(m) - s.diffuse, vec3(0.0f));
  s.f90 = min(15.0f * largest_channel(rest), 1.0f);
  s.f0 = max(rest - vec3(s.f90 * mean_schlick_weight), vec3(0.0f)) / (1.0f - mean_schlick_weight);
  s.dielectric_f0 = s.dielectric_f90 = 0.0f;
  return s;
}

LIMN_END
#endif  // LIMN_NEAREST_BRDF_GLSL
