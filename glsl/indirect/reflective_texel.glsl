// Texels of reflective shadow maps as the passes that make virtual lights read them.
#ifndef LIMN_REFLECTIVE_TEXEL_GLSL
#define LIMN_REFLECTIVE_TEXEL_GLSL
#include "glsl/gbuffer.glsl"
#include "glsl/reflective_map.glsl"

layout(binding = 0) uniform sampler2DArray reflective_depth;
layout(binding = 1) uniform sampler2DArray reflective_normal;
layout(binding = 2) uniform sampler2DArray reflective_albedo;
layout(std430, binding = 0) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 1) readonly buffer Views { ShadowView views[]; };
uniform int light_samples;  // points on lights with extent

struct ReflectiveTexel {
  vec3 position;  // world, m; the view's origin where there is nothing
  vec3 flux;      // reflected, W per unit of map area; 0 where there is nothing
};

ReflectiveTexel reflective_texel(ShadowView view, ivec2 texel) {
  float stored = texelFetch(reflective_depth, ivec3(texel, view.info.y), 0).r;
  vec2 uv = (vec2(texel) + 0.5) / float(view.info.z);
  vec3 offset = shadow_unproject_local(view, uv, shadow_metres(view, stored));
  ReflectiveTexel t;
  t.position = view.origin.xyz;
  t.flux = vec3(0.0);
  if (stored < 1.0) {
    t.position += shadow_world_offset(view, offset);
    vec3 albedo = srgb_decode(texelFetch(reflective_albedo, ivec3(texel, view.info.y), 0).rgb);
    t.flux = albedo * reflective_map_intensity(lights[view.info.w], view.origin.xyz, t.position, light_samples) *
             reflective_map_measure(view, uv);
  }
  return t;
}

// What layers and virtual lights are weighted by.
float flux_weight(vec3 flux) { return flux.x + flux.y + flux.z; }

#endif  // LIMN_REFLECTIVE_TEXEL_GLSL
