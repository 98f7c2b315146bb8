// The exact models of materials (extras.limn_material), by the kind of the material. GLSL compiles those of MATERIAL_MODELS, a
// mask of the bits 1 << kind, and C++ all.
//
// Directions v (to the viewer) and l (to the light) are unit, point away from the surface, and are given in the local frame:
// n = +z, the tangent = +x. v may lie below the horizon, as shading normals turn away.
#ifndef LIMN_MODEL_GLSL
#define LIMN_MODEL_GLSL
#ifdef __cplusplus
#include <vector>
#define MATERIAL_MODELS 254
#endif
#include "glsl/materials/material_model.glsl"
#include "glsl/numeric/geometry.glsl"
#if (MATERIAL_MODELS & 2) != 0
#include "glsl/materials/torrance_sparrow.glsl"
#endif
#if (MATERIAL_MODELS & 4) != 0
#include "glsl/materials/ward.glsl"
#endif
#if (MATERIAL_MODELS & 8) != 0
#include "glsl/materials/banks.glsl"
#endif
#if (MATERIAL_MODELS & 16) != 0
#include "glsl/materials/phong.glsl"
#endif
#if (MATERIAL_MODELS & 32) != 0
#include "glsl/materials/coated.glsl"
#endif
#if (MATERIAL_MODELS & 64) != 0
#include "glsl/materials/measured.glsl"
#endif
#if (MATERIAL_MODELS & 128) != 0
#include "glsl/materials/entry.glsl"
#endif
LIMN_BEGIN

// f cos(l), 1/sr; 0 where l lies below the horizon. A measured model needs its table: in C++ take the
// function below.
LIMN_FN vec3 model_response(MaterialModel m, vec3 v, vec3 l) {
  if (!(l.z > 0.0f)) return vec3(0.0f);
#if (MATERIAL_MODELS & 2) != 0
  if (m.kind == model_torrance_sparrow) return torrance_sparrow_response(m, v, l);
#endif
#if (MATERIAL_MODELS & 4) != 0
  if (m.kind == model_ward) return ward_response(m, v, l);
#endif
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return banks_response(m, v, l);
#endif
#if (MATERIAL_MODELS & 16) != 0
  if (m.kind == model_phong) return phong_response(m, v, l);
#endif
#if (MATERIAL_MODELS & 32) != 0
  if (m.kind == model_coated) return coated_response(m, v, l);
#endif
#if (MATERIAL_MODELS & 64) != 0 && !defined(__cplusplus)
  if (m.kind == model_measured) return measured_response(m.table, m, v, l);
#endif
#if (MATERIAL_MODELS & 128) != 0
  if (m.kind == model_entry) return entry_response(m, l);
#endif
  return vec3(0.0f);
}

#ifdef __cplusplus
// The same for every kind. measured: Scene::measured.
LIMN_FN vec3 model_response(const std::vector<vec3>& measured, const MaterialModel& m, vec3 v, vec3 l) {
  if (m.kind == model_measured) return measured_response(measured.data() + m.table, m, v, l);
  return model_response(m, v, l);
}
#endif

// A direction with density model_pdf, from u in [0, 1)^3. It may lie below the horizon (density 0: such a sample carries
// nothing).
LIMN_FN vec3 model_sample(MaterialModel m, vec3 v, vec3 u) {
#if (MATERIAL_MODELS & 2) != 0
  if (m.kind == model_torrance_sparrow) return torrance_sparrow_sample(m, v, u);
#endif
#if (MATERIAL_MODELS & 4) != 0
  if (m.kind == model_ward) return ward_sample(m, v, u);
#endif
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return banks_sample(m, v, u);
#endif
#if (MATERIAL_MODELS & 16) != 0
  if (m.kind == model_phong) return phong_sample(m, v, u);
#endif
#if (MATERIAL_MODELS & 64) != 0
  if (m.kind == model_measured) return measured_sample(m, v, u);
#endif
  return sample_cosine(vec2(u));
}

// The density of model_sample, 1/sr: positive wherever model_response is, and 0 below the horizon.
LIMN_FN float model_pdf(MaterialModel m, vec3 v, vec3 l) {
  if (!(l.z > 0.0f)) return 0.0f;
#if (MATERIAL_MODELS & 2) != 0
  if (m.kind == model_torrance_sparrow) return torrance_sparrow_pdf(m, v, l);
#endif
#if (MATERIAL_MODELS & 4) != 0
  if (m.kind == model_ward) return ward_pdf(m, v, l);
#endif
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return banks_pdf(m, v, l);
#endif
#if (MATERIAL_MODELS & 16) != 0
  if (m.kind == model_phong) return phong_pdf(m, v, l);
#endif
#if (MATERIAL_MODELS & 64) != 0
  if (m.kind == model_measured) return measured_pdf(m, v, l);
#endif
  return cosine_pdf(l.z);
}

// Hemispherical reflectance, about: an estimate in [0, 1] that costs no integral.
LIMN_FN vec3 model_albedo(MaterialModel m) {
#if (MATERIAL_MODELS & 2) != 0
  if (m.kind == model_torrance_sparrow) return torrance_sparrow_albedo(m);
#endif
#if (MATERIAL_MODELS & 4) != 0
  if (m.kind == model_ward) return ward_albedo(m);
#endif
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return banks_albedo(m);
#endif
#if (MATERIAL_MODELS & 16) != 0
  if (m.kind == model_phong) return phong_albedo(m);
#endif
#if (MATERIAL_MODELS & 32) != 0
  if (m.kind == model_coated) return coated_albedo(m);
#endif
#if (MATERIAL_MODELS & 64) != 0
  if (m.kind == model_measured) return measured_albedo(m);
#endif
#if (MATERIAL_MODELS & 128) != 0
  if (m.kind == model_entry) return m.kd;
#endif
  return vec3(0.0f);
}

// What kd alone reflects: f cos(l) of it, 1/sr, where l lies above the horizon, and its hemispherical reflectance.
LIMN_FN vec3 model_diffuse_response(MaterialModel m, vec3 l) {
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return m.kd * (banks_sine(l) * l.z);
#endif
  return m.kd * (inverse_pi * l.z);
}
LIMN_FN vec3 model_diffuse_albedo(MaterialModel m) {
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return banks_diffuse_albedo(m);
#endif
  return m.kd;
}

// The most light that the diffuse part and the lobe reflect together, over what arrives, in the channel that reflects most; kd
// and ks are to be divided by it where it is above 1. Of a coat it is the base alone.
LIMN_FN float model_excess(MaterialModel m) {
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return banks_excess(m);
#endif
#if (MATERIAL_MODELS & 6) != 0
  if (m.kind == model_torrance_sparrow || m.kind == model_ward)
    return microfacet_excess(m);
#endif
  return largest_channel(m.kind == model_phong ? m.kd + m.ks : m.kd);
}

LIMN_END
#endif  // LIMN_MODEL_GLSL
