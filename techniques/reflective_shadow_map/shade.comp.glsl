// Indirect light without shadows: every virtual light is seen from everywhere.
#define VPL_SHADOWS 0
#include "glsl/indirect/gather_main.glsl"
