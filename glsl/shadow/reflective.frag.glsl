// A texel of a reflective shadow map (glsl/indirect/reflective_map.glsl): depth as in shadow maps, geometric normal on the light's
// side, diffuse albedo. LAMBERTIAN 1: no material of the scene has a specular part. INSTANCES 1: in place of the albedo the draw
// instance, and no_instance on the backs of surfaces that have one side.
// MASKED, TEXTURES, COLOURS: see surface_input.glsl.
#include "glsl/surface/gbuffer.glsl"
#include "glsl/geometry/surface_input.glsl"
#if !INSTANCES && !LAMBERTIAN
#include "glsl/light/ltc.glsl"
#include "glsl/surface/reflectance.glsl"
#endif

layout(location = 0) in float linear_depth;
layout(location = 1) in vec3 from_light;

layout(location = 0) out float stored_depth;
layout(location = 1) out vec2 stored_normal;
#if INSTANCES
layout(location = 2) out uint stored_instance;
#else
layout(location = 2) out vec4 stored_albedo;

// Share of light from angle acos(cosine) to the normal that the diffuse part of the BRDF sends back, all directions
// together (the table's mean of Fresnel's weight; the diffuse part is the same with its directions exchanged).
vec3 diffuse_albedo(vec3 base, vec2 metal_rough, float cosine) {
#if LAMBERTIAN
  return base;
#else
  // A model sends back all that it reflects: of the metal next to it (setModel() in core/scene), that is its albedo.
  if ((material.flags & material_has_model) != 0u) return mix(base, vec3(1.0), mean_schlick_weight);
  vec3 colour = material.specular_factor > 0.0 ? material.specular_colour / material.specular_factor : vec3(1.0);
  SurfaceBrdf s = surface_brdf(base, metal_rough.x, metal_rough.y, material.specular_factor, colour, material.ior);
  return brdf_is_lambertian(s) ? s.diffuse : s.diffuse * ltc_diffuse_weight(s, ltc_lookup(cosine, s.alpha));
#endif
}
#endif

void main() {
#if !INSTANCES
  vec2 uv_dx = dFdxFine(surface_uv);
  vec2 uv_dy = dFdyFine(surface_uv);
#endif
#if MASKED
  alpha_test();
#endif
  vec3 along = normalize(from_light);
  vec3 normal = triangle_normal(along);
  bool back = !gl_FrontFacing && (material.flags & material_double_sided) == 0u;
  stored_depth = linear_depth < 1.0 ? max(linear_depth, 0.0) : 1.0;  // NaN: nothing there
  stored_normal = octahedral_encode(normal);
#if INSTANCES
  stored_instance = back ? no_instance : surface_instance.x;
#else
  vec3 albedo = diffuse_albedo(surface_base(uv_dx, uv_dy).rgb, surface_metal_rough(uv_dx, uv_dy), -dot(normal, along));
  if (back || (material.flags & material_specular_surface) != 0u) albedo = vec3(0.0);  // blocks light, sends none on
  stored_albedo = vec4(gbuffer_colour_encode(albedo), 1.0);
#endif
}
