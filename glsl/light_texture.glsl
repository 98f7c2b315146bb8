// What a light's texture does to the light that goes to a place, as passes read it. LIGHT_TEXTURES 0: no light of the scene has
// one; else core/scene/light_textures.h declares and binds them.
#ifndef LIMN_LIGHT_TEXTURE_GLSL
#define LIMN_LIGHT_TEXTURE_GLSL
#include "glsl/light.glsl"

#if LIGHT_TEXTURES
layout(binding = 14) uniform sampler2DArray light_textures;

vec3 light_texture(Light light, vec3 receiver) {
  if (light.direction.w == 0.0) return vec3(1.0);
  vec2 place = light_texture_place(light, receiver);
  return textureLod(light_textures, vec3(place, light.direction.w - 1.0), 0.0).rgb;
}
#else
vec3 light_texture(Light light, vec3 receiver) { return vec3(1.0); }
#endif

#endif  // LIMN_LIGHT_TEXTURE_GLSL
