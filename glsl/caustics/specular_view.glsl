// What the camera sees in a specular surface (transmission > 0, or metallic and smooth): the environment, mirrored and
// refracted once, with nothing in between. The GPU and the reference share this limit.
#ifndef LIMN_SPECULAR_VIEW_GLSL
#define LIMN_SPECULAR_VIEW_GLSL
#include "glsl/surface/brdf.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/scene/media.glsl"
LIMN_BEGIN

// Two lookups of the environment: radiance = reflected * L(reflection) + transmitted * L(refraction).
struct SpecularView {
  vec3 reflection;   // unit, away from the surface
  vec3 reflected;    // Fresnel reflectance (Schlick)
  vec3 refraction;   // unit, into the surface; straight on for a thin wall
  vec3 transmitted;
};

// By how much an instance scales lengths, in the mean over directions: glTF gives the thickness of a body in the space of its mesh
// (KHR_materials_volume).
LIMN_FN float body_scale(mat3 to_world) { return pow(abs(determinant(to_world)), 1.0f / 3.0f); }

// n: shading normal; v: unit, to the viewer; base_colour and transmission as glTF has them (KHR_materials_transmission:
// what passes is tinted by the base colour). thickness 0: a thin wall, which does not bend; else the surface of a body
// of that index of refraction, absorbing over its thickness (metres in the world; KHR_materials_volume; attenuation_distance 0:
// clear).
LIMN_FN SpecularView specular_view(SurfaceBrdf s, vec3 base_colour, float metallic, float transmission, float ior,
                                   float thickness, vec3 attenuation_colour, float attenuation_distance, vec3 n,
                                   vec3 v) {
  float cosine = clamp(dot(n, v), 0.0f, 1.0f);
  SpecularView r;
  r.reflection = reflect(-v, n);
  r.reflected = mix(s.f0, vec3(s.f90), schlick_weight(cosine));
  r.refraction = -v;
  float passes = transmission * (1.0f - metallic) * brdf_diffuse_weight(s, cosine);
  r.transmitted = passes * base_colour;
  if (thickness > 0.0f) {
    vec3 bent = refract(-v, n, 1.0f / max(ior, 1.0f));
    if (dot(bent, bent) > 0.0f) r.refraction = normalize(bent);
    r.transmitted *= body_absorption(attenuation_colour, attenuation_distance, thickness);
  }
  return r;
}

LIMN_END
#endif  // LIMN_SPECULAR_VIEW_GLSL
