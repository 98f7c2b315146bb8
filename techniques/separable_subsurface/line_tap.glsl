// What is known of a translucent material's light along lines, as C++ makes it and shaders read it.
#ifndef LINE_TAP_GLSL
#define LINE_TAP_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

struct LineTap {
  vec3 weight;   // part of the light that is taken from here, per channel
  float offset;  // distance along the surface, m
};

struct LineMaterial {
  vec3 reflectance;   // C: of all light that enters, what leaves; of the mean albedo where textured is 1
  float eta;          // index of refraction
  vec3 extinction;    // sigma_t', 1/m
  float width;        // line_width() of the mean albedo, m
  float entering;     // 1 - F_de (DiffusionBoundary)
  float depth_limit;  // m by which a tap may be off in depth before its light is not taken
  uint first_tap;
  uint textured;      // 1: the albedo is the pixel's base colour
};

LIMN_END
#endif  // LINE_TAP_GLSL
