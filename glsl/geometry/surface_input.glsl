// What fragment shaders that look at materials start from: the surface's inputs, its textures and its triangle. MASKED 1:
// some coverage may lie below the material's alpha cutoff. TEXTURES: which textures the material has
// (material_has_*), a constant because software renderers execute both sides of every branch. COLOURS 1: vertex colours.
#ifndef LIMN_SURFACE_INPUT_GLSL
#define LIMN_SURFACE_INPUT_GLSL
#include "glsl/geometry/triangle_input.glsl"
#include "glsl/surface/texture_level.glsl"

layout(location = 2) in vec2 surface_uv;
#if COLOURS
layout(location = 3) in vec4 surface_colour;
#endif
layout(std140) uniform MaterialBlock { Material material; };  // of the draw, at a constant place

const uint textures = TEXTURES;

uniform sampler2D base_colour_texture;
uniform sampler2D metal_rough_texture;
uniform sampler2D normal_texture;
uniform sampler2D emissive_texture;
uniform sampler2D height_slopes;  // of the height map, along u and v

vec4 texel(sampler2D image, vec2 uv_dx, vec2 uv_dy) {
  return textureLod(image, surface_uv, texture_level(uv_dx, uv_dy, vec2(textureSize(image, 0))));
}

// Linear base colour; a: coverage. That of a model is its own: vertices and textures decide on its coverage alone.
vec4 surface_base(vec2 uv_dx, vec2 uv_dy) {
  vec4 base = material.base_colour;
#if COLOURS
  base *= surface_colour;
#endif
  if ((textures & material_has_base_colour_texture) != 0u) base *= texel(base_colour_texture, uv_dx, uv_dy);
  bool own = (material.flags & material_has_model) != 0u;
  return vec4(own ? material.base_colour.rgb : base.rgb, base.a);
}

#if MASKED
// Drops fragments that the mask cuts out, at texture level 0, as shadow maps and the reference's shadow rays do.
void alpha_test() {
  float alpha = material.base_colour.a;
#if COLOURS
  alpha *= surface_colour.a;
#endif
  if ((textures & material_has_base_colour_texture) != 0u) {
    alpha *= textureLod(base_colour_texture, surface_uv, 0.0).a;
  }
  if (alpha < material.alpha_cutoff) discard;
}
#endif

// Metallic and perceptual roughness.
vec2 surface_metal_rough(vec2 uv_dx, vec2 uv_dy) {
  vec2 metal_rough = vec2(material.metallic, material.roughness);
  if ((textures & material_has_metal_rough_texture) != 0u) {
    metal_rough *= texel(metal_rough_texture, uv_dx, uv_dy).bg;
  }
  return metal_rough;
}

#endif  // LIMN_SURFACE_INPUT_GLSL
