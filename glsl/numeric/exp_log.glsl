// e^x - 1 and ln(1 + x), which GLSL lacks, with their relative precision at x = 0.
#ifndef LIMN_EXP_LOG_GLSL
#define LIMN_EXP_LOG_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Within 4e-7 of its value, by the series where the difference would cancel.
LIMN_FN float exp_minus_one(float x) {
  if (abs(x) >= 0.5f) return exp(x) - 1.0f;
  float tail = 1.0f + x / 6.0f * (1.0f + x / 7.0f * (1.0f + x / 8.0f));
  return x * (1.0f + x / 2.0f * (1.0f + x / 3.0f * (1.0f + x / 4.0f * (1.0f + x / 5.0f * tail))));
}

// x > -1. Within 3e-7 of its value, by the series of 2 atanh(x / (2 + x)).
LIMN_FN float log_one_plus(float x) {
  if (abs(x) >= 0.5f) return log(1.0f + x);
  float t = x / (2.0f + x);
  float t2 = t * t;
  float tail = 1.0f / 9.0f + t2 * (1.0f / 11.0f + t2 * (1.0f / 13.0f + t2 / 15.0f));
  return 2.0f * t * (1.0f + t2 * (1.0f / 3.0f + t2 * (1.0f / 5.0f + t2 * (1.0f / 7.0f + t2 * tail))));
}

LIMN_END
#endif  // LIMN_EXP_LOG_GLSL
