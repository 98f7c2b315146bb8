// What the surface of a pixel reflects of the lights that stand for the environment, unoccluded, in the parts of
// reflected_environment(): weights for how much of it is seen. They are of the metallic-roughness surface that the environment is
// filtered for; of coats, whose lobe mirrors, of a smooth metal, and of translucent surfaces of all that arrives.
#ifndef LIMN_ENVIRONMENT_SHARE_GLSL
#define LIMN_ENVIRONMENT_SHARE_GLSL
#include "glsl/light/unshadowed_light.glsl"
#include "glsl/surface/surface_response.glsl"

SurfaceMaterial sharing_material(SurfaceMaterial own) {
  SurfaceMaterial m = own;
#if (MATERIAL_MODELS & 128) != 0
  m.brdf = surface_brdf(vec3(1.0), 0.0, 1.0, 0.0, vec3(1.0), own.model.eta.x);
#elif MATERIAL_MODELS
  if (has_model(own)) m.brdf = nearest_brdf(own);
#if (MATERIAL_MODELS & 32) != 0
  if (own.model.kind == model_coated) {
    m.brdf.f0 = vec3(1.0);
    m.brdf.f90 = 1.0;
    m.brdf.alpha = brdf_min_alpha;
  }
#endif
#endif
#if MATERIAL_MODELS
  m.model.kind = model_none;
#endif
  return m;
}

// light: of the environment; m: a sharing_material(); n, ng: shading and geometric normal; v: unit, to the viewer.
ReflectedParts environment_share(Light light, SurfaceMaterial m, vec3 n, vec3 ng, vec3 v) {
  if ((light.flags & light_flag_centre) == 0u) {
    Rectangle seen = rectangle_from(light, vec3(0.0));
    return scaled_parts(unshadowed_rectangle_parts(seen, m.brdf, n, ng, v), rectangle_radiance(light));
  }
  if (dot(ng, light.direction) >= 0.0) return ReflectedParts(vec3(0.0), vec3(0.0));
  return scaled_parts(surface_response_parts(m, n, v, -light.direction), light.emission);
}

#endif  // LIMN_ENVIRONMENT_SHARE_GLSL
