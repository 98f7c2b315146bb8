// Lobes cos^p about a direction, p in [0, 1e6].
#ifndef LIMN_POWER_LOBE_GLSL
#define LIMN_POWER_LOBE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// log(1 - x) for x in [0, 1). Below 0.5 it is -2 artanh(x / (2 - x)) by its series, within 1e-7 of its value: 1 - x has lost
// the digits of a small x.
LIMN_FN float log_one_minus(float x) {
  float y = x / (2.0f - x);
  float y2 = y * y;
  float sum = 1.0f + y2 * (0.33333333f + y2 * (0.2f + y2 * (0.14285714f + y2 * (0.11111111f + y2 * (0.09090909f +
              y2 * 0.07692308f)))));
  return x < 0.5f ? -2.0f * y * sum : log(max(1.0f - x, 1e-7f));
}

// 1 - exp(-x) for x >= 0, digits of a small x kept likewise.
LIMN_FN float one_minus_exp(float x) {
  float sum = 1.0f - x / 8.0f;
  for (int i = 7; i > 1; --i) sum = 1.0f - x / float(i) * sum;
  return x < 0.5f ? x * sum : 1.0f - exp(-x);
}

// cos^p of the angle between unit vectors whose difference has the squared length distance2; 0 where it is not acute.
LIMN_FN float power_of_cosine(float distance2, float p) {
  return distance2 < 2.0f ? exp(p * log_one_minus(0.5f * distance2)) : 0.0f;
}

// A direction about +z with density (p + 1) / (2 pi) cos^p.
LIMN_FN vec3 sample_power_lobe(float p, vec2 u) {
  float below = one_minus_exp(-log(1.0f - u.x) / (p + 1.0f));  // 1 - cosine
  float sine = sqrt(below * (2.0f - below));
  float azimuth = 2.0f * pi * u.y;
  return vec3(sine * cos(azimuth), sine * sin(azimuth), 1.0f - below);
}

LIMN_END
#endif  // LIMN_POWER_LOBE_GLSL
