// Virtual lights: what indirect light is gathered from. Layouts that C++ and GLSL share.
#ifndef LIMN_VIRTUAL_LIGHT_GLSL
#define LIMN_VIRTUAL_LIGHT_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// A point of a lit surface that sends light on (Keller 1997, "Instant radiosity"): a Lambertian sender of radiant
// intensity flux / pi * cos(angle to the normal). Element of a storage buffer; a point where the light met nothing has
// flux 0: no receiver is lit by it, nothing is drawn into its map, and it counts in no cluster.
struct VirtualPointLight {
  vec3 position;  // world, m
  float cluster;  // that the light belongs to, in a sorted list
  vec3 normal;    // unit, on the side the light came from
  float area;     // of the surface that it stands for, m^2
  vec4 flux;      // reflected, W
};

LIMN_FN bool virtual_light_shines(VirtualPointLight light) {
  return light.flux.x + light.flux.y + light.flux.z > 0.0f;
}

LIMN_END
#endif
