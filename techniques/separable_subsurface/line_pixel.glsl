// The translucent materials of pixels. TEXTURED 1: the albedo of a material may be that of the pixel. NORMALISED: see
// glsl/diffusion/profile.glsl.
#ifndef LINE_PIXEL_GLSL
#define LINE_PIXEL_GLSL
#include "glsl/diffusion/boundary.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "techniques/separable_subsurface/line_tap.glsl"
#if TEXTURED
#include "glsl/diffusion/profile.glsl"
#include "techniques/separable_subsurface/line_width.glsl"
#endif

#ifdef LINE_MATERIAL_COUNT  // they fit a uniform block, from which all invocations load at once
layout(std140) uniform LineMaterials { LineMaterial line_materials[LINE_MATERIAL_COUNT]; };
#else
layout(std430) readonly buffer LineMaterials { LineMaterial line_materials[]; };
#endif
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer LineMaterialRows { uint line_material_rows[]; };  // of each material of the scene

const uint no_line_material = 0xffffffffu;  // of what is opaque

// Of a pixel of this draw instance: the index of its material in line_materials, or no_line_material.
uint line_material_of(uint instance) {
  return instance == no_instance ? no_line_material : line_material_rows[instances[instance].material];
}

// By how much light goes further below a pixel than taps say.
float width_over_taps(LineMaterial m, ivec2 pixel) {
#if TEXTURED
  if (m.textured != 0u) {
    vec3 albedo = gbuffer_colour_decode(texelFetch(gbuffer_albedo, pixel, 0).rgb);
    float width = line_width(albedo, m.extinction, walk_reflectance(diffusion_boundary(m.eta, m.entering)));
    return min(width / max(m.width, 1e-30), 1e6);
  }
#endif
  return 1.0;
}

// Square root of C at a pixel. Light takes it once where it enters and once where it leaves, so that both ways between two
// places lose the same.
vec3 root_reflectance(LineMaterial m, ivec2 pixel) {
  vec3 reflectance = m.reflectance;
#if TEXTURED
  if (m.textured != 0u) {
    vec3 albedo = gbuffer_colour_decode(texelFetch(gbuffer_albedo, pixel, 0).rgb);
    reflectance = profile_reflectance(albedo, diffusion_boundary(m.eta, m.entering));
  }
#endif
  return sqrt(reflectance);
}

#endif  // LINE_PIXEL_GLSL
