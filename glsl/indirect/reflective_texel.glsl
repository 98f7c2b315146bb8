// Texels of reflective shadow maps as the passes that make virtual lights read them. MEDIUM 1: the medium takes of the light on its
// way to them.
#ifndef LIMN_REFLECTIVE_TEXEL_GLSL
#define LIMN_REFLECTIVE_TEXEL_GLSL
#include "glsl/surface/gbuffer.glsl"
#include "glsl/light/light_texture.glsl"
#include "glsl/media/light_transmittance.glsl"
#include "glsl/indirect/reflective_map.glsl"

uniform sampler2DArray reflective_depth;
uniform sampler2DArray reflective_normal;
uniform sampler2DArray reflective_albedo;
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };
uniform int light_samples;  // points on lights with extent

struct ReflectiveTexel {
  vec3 position;  // world, m; the view's origin where there is nothing
  vec3 normal;
  vec3 flux;      // reflected, W per unit of map area; 0 where there is nothing
};

// Intensity that the light of a view has for a texel of its map, without a medium.
vec3 texel_intensity(ShadowView view, ReflectiveTexel t) {
  Light light = lights[view.light];
  vec3 intensity = reflective_map_intensity(light, t.position, light_samples);
  if (reflective_map_is_rectangle(light)) {
    vec3 towards = view.projection == shadow_orthographic ? -view.axis_z : view.origin - t.position;
    intensity = reflective_map_rectangle_intensity(light, towards, t.position, t.normal, light_samples);
  }
  return intensity * light_texture(light, t.position);
}

ReflectiveTexel reflective_texel(ShadowView view, ivec2 texel) {
  ivec3 at = ivec3(texel, view.layer);
  float stored = texelFetch(reflective_depth, at, 0).r;
  ReflectiveTexel t;
  t.position = view.origin;
  t.normal = octahedral_decode(texelFetch(reflective_normal, at, 0).xy);
  t.flux = vec3(0.0);
  if (stored < 1.0) {
    t.position += shadow_world_offset(view, shadow_texel_offset(view, texel, stored));
    vec3 albedo = gbuffer_colour_decode(texelFetch(reflective_albedo, at, 0).rgb);
    vec2 uv = (vec2(texel) + 0.5) / float(view.size);
    t.flux = albedo * texel_intensity(view, t) * reflective_map_measure(view, uv);
#if MEDIUM
    t.flux *= light_transmittance(lights[view.light], t.position);
#endif
  }
  return t;
}

// What layers and virtual lights are weighted by.
float flux_weight(vec3 flux) { return flux.x + flux.y + flux.z; }

#endif  // LIMN_REFLECTIVE_TEXEL_GLSL
