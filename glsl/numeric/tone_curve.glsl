// How linear radiance becomes what a display shows: exposure, then one of three tone curves, then sRGB.
//
// none:    clamp(2^EV L), the one whose values can be compared (glsl/numeric/srgb.glsl).
// neutral: the Khronos PBR Neutral Tone Mapper (Khronos Group 2024): what is not bright keeps its base colour, which a
//          toe darkens by the reflectance of a dielectric, 4 %; highlights are compressed and lose saturation.
// agx:     AgX (Sobotka 2022): the logarithm of light in primaries that are inset towards grey, through a sigmoid that
//          takes middle grey, 0.18, to the middle of the display's codes.
#ifndef LIMN_TONE_CURVE_GLSL
#define LIMN_TONE_CURVE_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/numeric/srgb.glsl"
LIMN_BEGIN

LIMN_CONST uint tone_curve_none = 0u;
LIMN_CONST uint tone_curve_neutral = 1u;
LIMN_CONST uint tone_curve_agx = 2u;

// Where the neutral curve begins to compress: 0.8, less the toe's offset.
LIMN_CONST float neutral_offset = 0.04f;
LIMN_CONST float neutral_knee = 0.8f - neutral_offset;

// Linear light to linear values of the display in [0, 1]; `light` in [0, 1e9].
LIMN_FN vec3 neutral_curve(vec3 light) {
  const float desaturation = 0.15f;
  float least = min(light.x, min(light.y, light.z));
  vec3 colour = light - (least < 2.0f * neutral_offset ? least - 6.25f * least * least : neutral_offset);
  float peak = max(colour.x, max(colour.y, colour.z));
  if (peak < neutral_knee) return max(colour, vec3(0.0f));
  float room = 1.0f - neutral_knee;
  float compressed = 1.0f - room * room / (peak + room - neutral_knee);
  float grey = 1.0f - 1.0f / (desaturation * (peak - compressed) + 1.0f);
  return clamp(mix(colour * (compressed / peak), vec3(compressed), grey), vec3(0.0f), vec3(1.0f));
}

// The middle of AgX's logarithmic scale: 0.18 is 10 of its 16.5 stops above the least light, 0.18 * 2^-10.
LIMN_CONST float agx_stops_below = 10.0f;
LIMN_CONST float agx_stops = 16.5f;
LIMN_CONST float agx_pivot = agx_stops_below / agx_stops;

// AgX's sigmoid of a place on that scale, 0 to 1: slope 2 through (agx_pivot, 1/2), with powers 3 and 3.25 below and
// above it, and scales by which it meets (0, 0) and (1, 1).
LIMN_FN float agx_sigmoid(float place) {
  float apart = place - agx_pivot;
  bool above = apart > 0.0f;
  float power = above ? 3.25f : 3.0f;
  float end = above ? 1.0f - agx_pivot : agx_pivot;
  float scale = pow(4.0f, power) - pow(end, -power);
  return 0.5f + 2.0f * apart * pow(1.0f + scale * pow(abs(apart), power), -1.0f / power);
}

// Linear light to the display's codes in [0, 1].
LIMN_FN vec3 agx_codes(vec3 light) {
  const mat3 inset = mat3(vec3(0.8424010709f, 0.0424010709f, 0.0424010709f),
                          vec3(0.0784365016f, 0.8784365016f, 0.0784365016f),
                          vec3(0.0791624275f, 0.0791624275f, 0.8791624275f));
  const mat3 outset = mat3(vec3(1.1969986613f, -0.0530013387f, -0.0530013387f),
                           vec3(-0.0980456270f, 1.1519543730f, -0.0980456270f),
                           vec3(-0.0989530344f, -0.0989530344f, 1.1510469656f));
  vec3 stops = log2(max(inset * light, vec3(1e-10f)) / 0.18f) + agx_stops_below;
  vec3 places = clamp(stops / agx_stops, vec3(0.0f), vec3(1.0f));
  vec3 codes = vec3(agx_sigmoid(places.x), agx_sigmoid(places.y), agx_sigmoid(places.z));
  return clamp(outset * codes, vec3(0.0f), vec3(1.0f));
}

// 2^exposure_ev * radiance as the curves take it: NaN and what is negative become 0.
LIMN_FN float exposed_light(float radiance, float exposure_ev) {
  float light = radiance * exp2(exposure_ev);
  return light > 0.0f ? min(light, 1e9f) : 0.0f;
}

// What a display shows of linear radiance, as sRGB codes in [0, 1]. NaN becomes 0.
LIMN_FN vec3 tone_map(vec3 radiance, float exposure_ev, uint curve) {
  if (curve == tone_curve_none) return tone_map(radiance, exposure_ev);
  vec3 light = vec3(exposed_light(radiance.x, exposure_ev), exposed_light(radiance.y, exposure_ev),
                    exposed_light(radiance.z, exposure_ev));
  return curve == tone_curve_agx ? agx_codes(light) : srgb_encode(neutral_curve(light));
}

LIMN_END
#endif  // LIMN_TONE_CURVE_GLSL
