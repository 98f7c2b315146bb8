// One sample of the environment's light, an element of the buffer of samples.
#ifndef LIMN_ENVIRONMENT_SAMPLE_GLSL
#define LIMN_ENVIRONMENT_SAMPLE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

struct EnvironmentSample {
  vec3 irradiance;  // W/m^2 on surfaces that face it, were it all
  float unused_0;
  vec3 direction;  // unit, towards it, world
  float unused_1;
};

LIMN_END
#endif  // LIMN_ENVIRONMENT_SAMPLE_GLSL
