// What a receiver gets from a virtual point light, with the inverse square bounded.
//
// A virtual light stands for a patch of surface of which a receiver closer than the patch is wide gets too much: a bright
// spot, whose expectation is right and whose variance is not bounded. Bounding 1/d^2 takes the spots away and darkens what
// is close to lit surfaces. What the bound cuts off is the residual; it is gathered, too, and spread over the
// neighbourhood in the image (screen-space compensation after Novak et al. 2011, Screen-Space Bias Compensation for
// Interactive High-Quality Global Illumination with Virtual Point Lights, by a filter instead of their recursion).
#ifndef LIMN_GATHER_GLSL
#define LIMN_GATHER_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// --- 1 / d^2 as if no nearer than `nearest` metres; what a receiver and all lights have in common is squared once ---

// (cosine at the receiver) (cosine at the light) / max(d2, nearest2), from the products of the two unit normals with the
// offset to the other's place, both positive. nearest2: nearest^2. One division, and finite however near they are.
LIMN_FN float gather_geometry(float towards_light, float towards_receiver, float d2, float nearest2) {
  return towards_light * towards_receiver / max(d2 * max(d2, nearest2), 1e-37f);
}

// What another bound gives over what nearest2 gives.
LIMN_FN float gather_rebound(float d2, float nearest2, float other2) { return max(d2, nearest2) / max(d2, other2); }

// What the bound cuts off, over what it leaves, averaged over a receiver of `footprint` metres: the mean of 1/d^2 over it
// is no greater than at the distance footprint / sqrt(pi). least: footprint^2 / pi.
LIMN_FN float gather_residual(float d2, float nearest2, float least) {
  return max(gather_rebound(d2, nearest2, least) - 1.0f, 0.0f);
}

// --- The same for lights that stand for a patch of `area` m^2 as wide as they are high: 1 / (d^2 + area / pi), which is exact
// above the middle of a disc. patch2: area / pi, of as many lights as a pixel is the mean of ---

LIMN_FN float gather_patch_geometry(float towards_light, float towards_receiver, float d2, float patch2) {
  return towards_light * towards_receiver / max(d2 * (d2 + patch2), 1e-37f);
}

// What another patch gives over what patch2 gives.
LIMN_FN float gather_patch_rebound(float d2, float patch2, float other2) {
  return (d2 + patch2) / max(d2 + other2, 1e-37f);
}

// What a smaller patch, or footprint^2 / pi of a receiver, adds to that of patch2, over it.
LIMN_FN float gather_patch_residual(float d2, float patch2, float least) {
  return max(gather_patch_rebound(d2, patch2, least) - 1.0f, 0.0f);
}

// Virtual lights of a pixel in block x block interleaved pixels (Segovia et al. 2006, Non-interleaved Deferred Shading of
// Interleaved Sample Patterns): sub-buffer k of block^2 has the consecutive lights [k N / block^2, (k + 1) N / block^2),
// which a low-discrepancy sequence spreads over all lit surfaces.
LIMN_FN uint gather_begin(uint sub_buffer, uint count, uint block) { return sub_buffer * count / (block * block); }

// The sub-buffer that has a light.
LIMN_FN uint gather_sub_buffer(uint light, uint count, uint block) {
  uint sub_buffer = light * block * block / count;
  while (gather_begin(sub_buffer + 1u, count, block) <= light) ++sub_buffer;
  return sub_buffer;
}

LIMN_END
#endif  // LIMN_GATHER_GLSL
