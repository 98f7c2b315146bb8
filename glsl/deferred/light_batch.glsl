// A batch of lights, and what is left of each at a pixel. LIGHT_COUNT: how many. VISIBILITY 1, RELIEF 1: V and W are known, a layer
// per light; else they are 1. MEDIUM 1: the medium takes its part (light_transmittance()).
#ifndef LIMN_LIGHT_BATCH_GLSL
#define LIMN_LIGHT_BATCH_GLSL
#include "glsl/media/light_transmittance.glsl"
#include "glsl/scene/light.glsl"

layout(std430) readonly buffer Lights { Light lights[]; };
#if VISIBILITY
uniform sampler2DArray visibility;
#endif
#if RELIEF
uniform sampler2DArray relief;
#endif
uniform uint light_indices[LIGHT_COUNT];

// V W of a light of the batch.
float light_factor(ivec2 pixel, int i) {
  float lit = 1.0;
#if VISIBILITY
  lit = texelFetch(visibility, ivec3(pixel, i), 0).x;
#endif
#if RELIEF
  lit *= texelFetch(relief, ivec3(pixel, i), 0).x;
#endif
  return lit;
}

#endif  // LIMN_LIGHT_BATCH_GLSL
