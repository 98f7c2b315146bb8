// What scatters below the surfaces of one material, and how points are drawn for it.
#ifndef DIFFUSION_BODY_GLSL
#define DIFFUSION_BODY_GLSL
#include "glsl/diffusion/drawn_points.glsl"
LIMN_BEGIN

// The unit of length is how far light of the channel that reaches farthest gets in the mean. An element of a storage block.
struct DiffusionBody {
  vec3 extinction;  // of the channels, per unit of length
  float unit;       // m
  vec3 absorption;  // 1 - a'; where it is textured, the least
  float eta;
  vec3 channels;         // see PointSource
  float uniform_share;   // of points
  float uniform_radius;  // units
  uint textured;         // 1: a texture or vertex colours replace the absorption
  uint first_point;      // of its points among those of all bodies
  float entering;        // 1 - F_de
};

LIMN_CONST uint no_body = 0xffffffffu;

LIMN_END
#endif  // DIFFUSION_BODY_GLSL
