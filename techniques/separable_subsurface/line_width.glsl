// How far light goes below a surface of some albedo, as one number.
#ifndef LINE_WIDTH_GLSL
#define LINE_WIDTH_GLSL
#include "glsl/diffusion/normalised.glsl"
LIMN_BEGIN

// The mean over the channels of the widths of normalised diffusion, weighted by the albedo, in m. extinction: sigma_t', 1/m.
LIMN_FN float line_width(vec3 albedo, vec3 extinction, WalkReflectance walk) {
  float widths = 0.0f;
  float weights = 0.0f;
  for (int c = 0; c < 3; ++c) {
    NormalisedDiffusion profile = normalised_diffusion(walk_absorption(walk, albedo[c]), walk);
    widths += albedo[c] * profile.width / extinction[c];
    weights += albedo[c];
  }
  return widths / max(weights, 1e-20f);
}

LIMN_END
#endif  // LINE_WIDTH_GLSL
