// How much of diffuse light a surface reflects in all: what radiosity calls its albedo.
#ifndef LIMN_REFLECTANCE_GLSL
#define LIMN_REFLECTANCE_GLSL
#include "glsl/surface/brdf.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Mean over the cosine-weighted hemisphere of Schlick's weight (1 - cosine)^5: 2 int (1 - c)^5 c dc = 1/21.
LIMN_CONST float mean_schlick_weight = 0.047619048f;

// Of the specular part by the mean Fresnel reflectance: its colour, and 0 where there is none.
LIMN_FN vec3 specular_reflectance(SurfaceBrdf s) { return mix(s.f0, vec3(s.f90), mean_schlick_weight); }

// Hemispherical reflectance by the mean Fresnel reflectance; what single scattering loses at rough surfaces is not taken
// away. At most 1.
LIMN_FN vec3 hemispherical_reflectance(SurfaceBrdf s) {
  float dielectric = mix(s.dielectric_f0, s.dielectric_f90, mean_schlick_weight);
  return min(s.diffuse * (1.0f - dielectric) + specular_reflectance(s), vec3(1.0f));
}

LIMN_END
#endif  // LIMN_REFLECTANCE_GLSL
