// What a material with a model is made of: one element of the buffer of material models. glsl/materials/model.glsl evaluates it.
#ifndef LIMN_MATERIAL_MODEL_GLSL
#define LIMN_MATERIAL_MODEL_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint model_none = 0u;  // metallic-roughness (glsl/surface/brdf.glsl)
LIMN_CONST uint model_torrance_sparrow = 1u;
LIMN_CONST uint model_ward = 2u;
LIMN_CONST uint model_banks = 3u;
LIMN_CONST uint model_phong = 4u;
LIMN_CONST uint model_coated = 5u;
LIMN_CONST uint model_measured = 6u;
LIMN_CONST uint model_entry = 7u;  // of no material: what enters a translucent surface (glsl/materials/entry.glsl)

LIMN_CONST uint model_option_gaussian = 1u;   // torrance_sparrow: D is a Gaussian of the angle, not Beckmann's
LIMN_CONST uint model_option_product = 2u;    // torrance_sparrow, ward: masking and shadowing are independent
LIMN_CONST uint model_option_printed = 4u;    // banks: as printed, not as a function of l.t and v.t
LIMN_CONST uint model_option_blend = 8u;      // coated: F mirror + (1 - F) base
LIMN_CONST uint model_option_physical = 16u;  // coated: light is refracted into the coat, and out of it
LIMN_CONST uint model_option_pairs = 32u;     // measured: a table over pairs of directions

struct MaterialModel {
  vec3 eta;        // index of refraction of each channel, over that of air
  uint kind;       // model_none, ...
  vec3 k;          // index of absorption; 0: a dielectric (measured: hemispherical reflectance of the table)
  float exponent;  // phong, banks
  vec3 kd;         // albedo of the diffuse part (banks: its coefficient; measured: what the table has away from its lobe)
  uint options;    // model_option_*
  vec3 ks;         // factor on the lobe; its albedo (phong), its coefficient (banks)
  uint material;  // index of the material in the scene
  vec2 roughness;  // root mean square slope times sqrt(2), along the tangent and across it
  uint table;      // measured: index of its first value in Scene::measured
  uint nodes;      // measured: sizes of its table (measured_nodes)
};

// Roughness is clamped to this: single precision resolves the peak of D.
LIMN_CONST float model_min_roughness = 1e-3f;

LIMN_FN vec2 model_alpha(MaterialModel m) { return clamp(m.roughness, vec2(model_min_roughness), vec2(1.0f)); }

LIMN_FN float largest_channel(vec3 colour) { return max(colour.x, max(colour.y, colour.z)); }

// Probability of sampling the lobe where it reflects `lobe` and the diffuse part `diffuse`, both in [0, 1]. Neither part is
// starved, since both are estimates.
LIMN_FN float model_lobe_share(float lobe, float diffuse) {
  if (!(diffuse > 0.0f)) return 1.0f;
  return lobe > 0.0f ? clamp(lobe / (lobe + diffuse), 0.1f, 0.9f) : 0.0f;
}

// Whether the response changes where v and l turn about n together.
LIMN_FN bool model_anisotropic(MaterialModel m) {
  return m.kind == model_banks || (m.kind == model_ward && m.roughness.x != m.roughness.y) ||
         (m.kind == model_measured && (m.options & model_option_pairs) != 0u);
}

LIMN_END
#endif  // LIMN_MATERIAL_MODEL_GLSL
