// What fragment shaders that look at materials start from: the surface's inputs, its textures and its triangle. MASKED 1:
// some coverage may lie below the material's alpha cutoff. TEXTURES: which textures the material has
// (material_has_*), a constant because software renderers execute both sides of every branch. COLOURS 1: vertex colours.
#ifndef LIMN_SURFACE_INPUT_GLSL
#define LIMN_SURFACE_INPUT_GLSL
#include "glsl/blocks.glsl"
#include "glsl/texture_level.glsl"

layout(location = 2) in vec2 surface_uv;
#if COLOURS
layout(location = 3) in vec4 surface_colour;
#endif
layout(location = 4) flat in uvec3 surface_instance;  // draw instance, first vertex, first index

layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 2) readonly buffer Positions { float positions[]; };
layout(std430, binding = 3) readonly buffer Indices { uint indices[]; };
layout(std140, binding = 1) uniform MaterialBlock { Material material; };  // of the draw, at a constant place

const uint textures = TEXTURES;

layout(binding = 0) uniform sampler2D base_colour_texture;
layout(binding = 1) uniform sampler2D metal_rough_texture;

vec3 corner(int k) {
  uint vertex = surface_instance.y + indices[surface_instance.z + 3u * uint(gl_PrimitiveID) + uint(k)];
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Normal of the triangle from its corners, against `view_direction`: exact however small the triangle is on the screen, where
// derivatives of interpolated positions are not.
vec3 triangle_normal(vec3 view_direction) {
  vec3 a = corner(0);
  mat3 linear = mat3(instances[surface_instance.x].object_to_world);
  vec3 e = linear * (corner(1) - a);
  vec3 f = linear * (corner(2) - a);
  float scale = max(max(max(abs(e.x), abs(e.y)), abs(e.z)), max(max(abs(f.x), abs(f.y)), abs(f.z)));
  vec3 n = cross(e / scale, f / scale);
  float squared = dot(n, n);
  if (!(squared > 0.0)) return -view_direction;
  n *= inversesqrt(squared);
  return dot(n, view_direction) > 0.0 ? -n : n;
}

vec4 texel(sampler2D image, vec2 uv_dx, vec2 uv_dy) {
  return textureLod(image, surface_uv, texture_level(uv_dx, uv_dy, vec2(textureSize(image, 0))));
}

// Linear base colour; a: coverage.
vec4 surface_base(vec2 uv_dx, vec2 uv_dy) {
  vec4 base = material.base_colour;
#if COLOURS
  base *= surface_colour;
#endif
  if ((textures & material_has_base_colour_texture) != 0u) base *= texel(base_colour_texture, uv_dx, uv_dy);
  return base;
}

// Metallic and perceptual roughness.
vec2 surface_metal_rough(vec2 uv_dx, vec2 uv_dy) {
  vec2 metal_rough = material.metal_rough.xy;
  if ((textures & material_has_metal_rough_texture) != 0u) {
    metal_rough *= texel(metal_rough_texture, uv_dx, uv_dy).bg;
  }
  return metal_rough;
}

#endif  // LIMN_SURFACE_INPUT_GLSL
