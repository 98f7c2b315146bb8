// How the surface of a pixel reflects light, for every pass that reflects it: metallic-roughness, or the model of its
// material. MATERIAL_MODELS: bit 1 << kind of each model of the scene; 0: the program knows metallic-roughness alone; 128: the
// G-buffer is that of light which enters translucent surfaces (glsl/materials/entry.glsl).
// SURFACE_TANGENTS 1: the G-buffer holds tangents; SURFACE_PLACES 1: and places in height maps. SURFACE_ANSWER: see
// response.glsl.
#ifndef LIMN_SURFACE_RESPONSE_GLSL
#define LIMN_SURFACE_RESPONSE_GLSL
#include "glsl/surface/brdf.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/surface/reflected_parts.glsl"
#if MATERIAL_MODELS
#include "glsl/surface/nearest_brdf.glsl"
#include "glsl/materials/response.glsl"
#endif
#if (MATERIAL_MODELS & 127) != 0
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer MaterialModels { MaterialModel material_models[]; };  // of each material
#if SURFACE_TANGENTS
uniform sampler2D gbuffer_tangent;
#endif
#endif

struct SurfaceMaterial {
  SurfaceBrdf brdf;
#if MATERIAL_MODELS
  MaterialModel model;  // of kind model_none: brdf
  Frame frame;          // in which the model is evaluated
#endif
};

bool has_model(SurfaceMaterial m) {
#if MATERIAL_MODELS
  return m.model.kind != model_none;
#else
  return false;
#endif
}

// Whether it is a base under a coat that mirrors.
bool has_coat(SurfaceMaterial m) {
#if (MATERIAL_MODELS & 32) != 0
  return m.model.kind == model_coated;
#else
  return false;
#endif
}

// surface: that of the pixel.
SurfaceMaterial pixel_material(ivec2 pixel, GBufferSurface surface) {
  SurfaceMaterial m;
  m.brdf = surface_brdf(surface.base_colour, surface.metallic, surface.roughness, surface.specular_factor,
                        surface.specular_colour, surface.ior);
#if (MATERIAL_MODELS & 128) != 0
  m.model = entry_model(surface.ior);
  m.frame = frame_around(surface.normal);
#elif MATERIAL_MODELS
  uint instance = pixel_instance(pixel);
  m.model.kind = model_none;
  if (instance != no_instance) m.model = material_models[instances[instance].material];
#if SURFACE_TANGENTS
  vec4 tangent = texelFetch(gbuffer_tangent, pixel, 0);
  m.frame = frame_turned(surface.normal, tangent.x);
#if SURFACE_PLACES
  // Beside a place the tangent is that of the base, below the bumps.
  if (tangent.a > 0.0)
    m.frame = frame_along(surface.normal, frame_turned(surface.geometric_normal, tangent.x).t);
#endif
#else
  m.frame = frame_around(surface.normal);
#endif
#endif
  return m;
}

// f(v, l) times the cosine of l, 1/sr; 0 where l lies below the horizon. n: shading normal; v, l: unit, away from the surface.
vec3 surface_response(SurfaceMaterial m, vec3 n, vec3 v, vec3 l) {
#if MATERIAL_MODELS
  if (m.model.kind != model_none) return material_response(m.model, to_local(m.frame, v), to_local(m.frame, l));
#endif
  return brdf(m.brdf, n, v, l) * dot(n, l);
}

// The same in parts. Of a model the diffuse part is what kd alone would reflect, at most all of it, and what enters translucent
// surfaces has no lobe.
ReflectedParts surface_response_parts(SurfaceMaterial m, vec3 n, vec3 v, vec3 l) {
  ReflectedParts response = ReflectedParts(vec3(0.0), vec3(0.0));
  float n_dot_l = dot(n, l);
  if (!(n_dot_l > 0.0)) return response;
#if MATERIAL_MODELS
  if (m.model.kind != model_none) {
    vec3 whole = surface_response(m, n, v, l);
    bool enters = m.model.kind == model_entry || m.model.kind == model_coated;
    response.diffuse = enters ? whole : min(model_diffuse_response(m.model, to_local(m.frame, l)), whole);
    response.lobe = whole - response.diffuse;
    return response;
  }
#endif
  if (brdf_is_lambertian(m.brdf)) {
    response.diffuse = m.brdf.diffuse * (inverse_pi * n_dot_l);
    return response;
  }
  BrdfParts parts = brdf_parts(m.brdf, n, v, l);
  response.diffuse = m.brdf.diffuse * (parts.diffuse * n_dot_l);
  response.lobe = parts.specular * n_dot_l;
  return response;
}

#if MATERIAL_MODELS
SurfaceBrdf nearest_brdf(SurfaceMaterial m) { return nearest_brdf(m.model, m.brdf.alpha); }
#endif

#endif  // LIMN_SURFACE_RESPONSE_GLSL
