// What becomes of sums over drawn points of the light that enters where they are.
#ifndef LIMN_DIFFUSION_ENTRY_SUMS_GLSL
#define LIMN_DIFFUSION_ENTRY_SUMS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// How the sums become a mean of the entering light over the profile.
LIMN_CONST int entry_normalise_none = 0;     // over all points, those without a hit included: what is seen of the integral
LIMN_CONST int entry_normalise_count = 1;    // over the points with a hit, whose weights leave out how areas differ
LIMN_CONST int entry_normalise_weights = 2;  // over the sum of the weights: never above the light that enters anywhere

LIMN_FN float entry_ratio(float light, float weights, float otherwise) {
  return weights > 1e-30f ? light / weights : otherwise;
}

// The mean from the sums of weight times light and of weights, the latter being profile over density. `here`: the light that
// enters at the pixel itself, which stands for a channel that no point tells of, except where sums are over all points.
LIMN_FN vec3 entry_mean(vec3 light, vec3 weights, float hits, float points, int normalise, vec3 here) {
  if (normalise == entry_normalise_none) return light / points;
  if (hits == 0.0f) return here;
  if (normalise == entry_normalise_count) return light / hits;
  return vec3(entry_ratio(light.x, weights.x, here.x), entry_ratio(light.y, weights.y, here.y),
              entry_ratio(light.z, weights.z, here.z));
}

// The part of the profile that entry_mean() stands for where hidden places are added to it: of `inside` points in the picture
// `hits` met the body, and what lies beside the picture is still like what is seen. Weights are noisy: their share is no less
// than that of the points. Where all points lie beside the picture, the light at the pixel stands for all; where those in it meet
// nothing of the body, nothing of what leaves is seen to enter.
LIMN_FN vec3 entry_seen_share(vec3 weights, float hits, float inside, int normalise) {
  if (inside == 0.0f || normalise == entry_normalise_none) return vec3(1.0f);
  if (normalise == entry_normalise_count) return vec3(hits / inside);
  return clamp(weights, vec3(hits), vec3(inside)) / inside;
}

LIMN_END
#endif  // LIMN_DIFFUSION_ENTRY_SUMS_GLSL
