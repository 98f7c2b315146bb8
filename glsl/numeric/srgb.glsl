// The sRGB transfer curve (IEC 61966-2-1) and the one tone curve of this project: exposure, clamp, sRGB.
#ifndef LIMN_SRGB_GLSL
#define LIMN_SRGB_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Linear value in [0, 1] to sRGB in [0, 1].
LIMN_FN float srgb_encode(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * pow(value, 1.0f / 2.4f) - 0.055f;
}

// Inverse of srgb_encode.
LIMN_FN float srgb_decode(float value) {
  return value <= 0.04045f ? value / 12.92f : pow((value + 0.055f) / 1.055f, 2.4f);
}

LIMN_FN vec3 srgb_encode(vec3 colour) {
  return vec3(srgb_encode(colour.x), srgb_encode(colour.y), srgb_encode(colour.z));
}

LIMN_FN vec3 srgb_decode(vec3 colour) {
  return vec3(srgb_decode(colour.x), srgb_decode(colour.y), srgb_decode(colour.z));
}

// Relative luminance of linear Rec. 709 primaries.
LIMN_FN float luminance(vec3 colour) { return dot(colour, vec3(0.2126f, 0.7152f, 0.0722f)); }

// What a display shows of linear radiance: clamp(2^exposure_ev * radiance) in sRGB. NaN becomes 0.
LIMN_FN float tone_map(float radiance, float exposure_ev) {
  float exposed = radiance * exp2(exposure_ev);
  return exposed > 0.0f ? srgb_encode(min(exposed, 1.0f)) : 0.0f;
}

LIMN_FN vec3 tone_map(vec3 radiance, float exposure_ev) {
  return vec3(tone_map(radiance.x, exposure_ev), tone_map(radiance.y, exposure_ev),
              tone_map(radiance.z, exposure_ev));
}

LIMN_END
#endif  // LIMN_SRGB_GLSL
