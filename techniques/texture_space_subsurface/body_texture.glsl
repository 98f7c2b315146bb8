// The textures that the surfaces of translucent bodies are laid out in, a layer each: layouts that C++ and GLSL share.
#ifndef BODY_TEXTURE_GLSL
#define BODY_TEXTURE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint no_kind = 0xffffffffu;  // of opaque materials

// One corner of a triangle in a chart (storage buffer element).
struct ChartCorner {
  vec2 place;   // in the body's layer, texels
  uint vertex;  // of the body
  uint chart;   // from 1 on within the body: 0 is where no chart is
};

// One body (storage buffer element; index: its layer).
struct TexturedBody {
  uint instance;    // draw instance
  uint kind;        // of its material
  uvec2 unused;
};

// What the material of bodies reflects (storage buffer element).
struct TexturedKind {
  vec3 reflectance;  // C: of all light that enters, what leaves; unused where textured is 1
  float eta;         // index of refraction
  float entering;    // 1 - F_de (DiffusionBoundary)
  uint textured;     // 1: the albedo is that of each pixel
  uvec2 unused;
};

// One Gaussian of a kind (storage buffer element); those of a kind follow each other from narrow to wide.
struct SurfaceGaussian {
  vec3 weight;  // part of the light that leaves, per channel
  float sigma;  // m
};

// Weights of the tap at a place and of those one to three steps away to both sides: the parts of a Gaussian in bins one standard
// deviation wide (d'Eon, Luebke and Enderton 2007, section 5). What lies all over a bin is looked up at its middle, which would
// widen the Gaussian by 3.9 %; steps are shorter by that, so that the taps have its variance, to which those of all steps add up.
LIMN_CONST vec4 tap_weights = vec4(0.383f, 0.242f, 0.061f, 0.006f);
LIMN_CONST float tap_step = 0.9627f;  // standard deviations: the root of 1.001 / (2 (0.242 + 4 * 0.061 + 9 * 0.006))

// A Gaussian as wide as a texel or wider is spread in the texture, one below half a texel is left to the pixels' own light.
// texel: its size along u and v, m.
LIMN_FN float spread_share(float sigma, vec2 texel) {
  return clamp(2.0f * sigma / max(max(texel.x, texel.y), 1e-30f) - 1.0f, 0.0f, 1.0f);
}

LIMN_END
#endif  // BODY_TEXTURE_GLSL
