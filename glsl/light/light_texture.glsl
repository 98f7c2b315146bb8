// What a light's texture does to the light that goes to a place, as passes read it. LIGHT_TEXTURES 0: no light of the scene has
// one; else core/gpu_scene/light_textures.h declares them.
#ifndef LIMN_LIGHT_TEXTURE_GLSL
#define LIMN_LIGHT_TEXTURE_GLSL
#include "glsl/scene/light.glsl"

#if LIGHT_TEXTURES
uniform sampler2DArray light_textures;

vec3 light_texture(Light light, vec3 receiver) {
  if (light.texture_number == 0.0) return vec3(1.0);
  vec2 place = light_texture_place(light, receiver);
  return textureLod(light_textures, vec3(place, light.texture_number - 1.0), 0.0).rgb;
}
#else
vec3 light_texture(Light light, vec3 receiver) { return vec3(1.0); }
#endif

#endif  // LIMN_LIGHT_TEXTURE_GLSL
