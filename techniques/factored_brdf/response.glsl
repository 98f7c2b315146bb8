// Material models as products of tables (glsl/materials/factored.glsl), plus a floor. FACTORED_FIT: which product, or that of no
// table; analytic tables have one for each kind of model, and FACTORED_KINDS is the mask of those that occur (1 << kind).
// FACTORED_COMPLETE 0: some materials are evaluated exactly. FACTORED_WARPED: what tables and discs lie over.
// FACTORED_LAYERS: of a material in its first table, one for each product, two over discs; of a volume the slices.
#ifndef LIMN_FACTORED_RESPONSE_GLSL
#define LIMN_FACTORED_RESPONSE_GLSL
#include "glsl/materials/factored.glsl"
#include "glsl/materials/model.glsl"

#define FACTORED_EXACT 0
#define FACTORED_TABLES 1
#define FACTORED_DFG 2
#define FACTORED_PQP 3
#define FACTORED_PQP_DISC 4
#define FACTORED_DFG_DISC 5
#define FACTORED_SVD 6
#define FACTORED_TRILINEAR 7
#define FACTORED_ANALYTIC 8

#if FACTORED_FIT == FACTORED_EXACT
vec3 material_response(MaterialModel m, vec3 v, vec3 l) { return model_response(m, v, l); }
#else
#if FACTORED_FIT != FACTORED_ANALYTIC
#define FACTORED_KINDS 0
#endif
#define FACTORED_PAIR (FACTORED_FIT == FACTORED_TABLES || FACTORED_FIT == FACTORED_DFG_DISC || FACTORED_FIT == FACTORED_SVD)
#if FACTORED_FIT != FACTORED_ANALYTIC || (FACTORED_KINDS & 2) != 0
uniform sampler2DArray factored_1;
#endif
#if FACTORED_PAIR || (FACTORED_KINDS & 2) != 0
uniform sampler2DArray factored_2;
#endif
#if (FACTORED_KINDS & 4) != 0
uniform sampler2DArray factored_slopes;
uniform sampler2DArray factored_slope_rows;
#endif
#if (FACTORED_KINDS & 8) != 0
uniform sampler2DArray factored_fibres;
#endif
uniform sampler2D factored_materials;  // of each, row 0: rgb: scale; a: its tables, -1: none; row 1: rgb: floor

vec3 factored_product(MaterialModel m, int first, vec3 v, vec3 l) {
#if (FACTORED_KINDS & 4) != 0
  if (m.kind == model_ward)
    return factored_slopes_response(factored_slopes, factored_slope_rows, first, model_alpha(m),
                                    (m.options & model_option_product) != 0u, v, l, FACTORED_WARPED);
#endif
#if (FACTORED_KINDS & 8) != 0
  if (m.kind == model_banks) return factored_fibres_response(factored_fibres, first, v, l);
#endif
#if FACTORED_FIT == FACTORED_PQP_DISC
  return factored_pqp_disc_response(factored_1, first, FACTORED_LAYERS / 2, v, l, FACTORED_WARPED);
#elif FACTORED_FIT == FACTORED_DFG_DISC
  return factored_dfg_disc_response(factored_1, factored_2, first, FACTORED_LAYERS / 2, v, l, FACTORED_WARPED);
#elif FACTORED_FIT == FACTORED_SVD
  return factored_svd_response(factored_1, factored_2, first, FACTORED_LAYERS, v, l);
#elif FACTORED_FIT == FACTORED_TRILINEAR
  return factored_volume_response(factored_1, first, FACTORED_LAYERS, v, l);
#elif FACTORED_FIT == FACTORED_ANALYTIC && (FACTORED_KINDS & 2) == 0
  return vec3(0.0);
#else
  FactoredAngles a = factored_angles(vec3(0.0, 0.0, 1.0), v, l);
#if FACTORED_FIT == FACTORED_TABLES || FACTORED_FIT == FACTORED_ANALYTIC
  return factored_response(factored_1, factored_2, first, a, FACTORED_WARPED);
#elif FACTORED_FIT == FACTORED_DFG
  return factored_dfg_response(factored_1, first, FACTORED_LAYERS, a);
#else
  return factored_pqp_response(factored_1, first, FACTORED_LAYERS, a);
#endif
#endif
}

vec3 material_response(MaterialModel m, vec3 v, vec3 l) {
  vec4 scale = texelFetch(factored_materials, ivec2(m.material, 0), 0);
#if !FACTORED_COMPLETE
  if (scale.a < 0.0) return model_response(m, v, l);
#endif
  if (!(l.z > 0.0)) return vec3(0.0);
  vec3 diffuse = texelFetch(factored_materials, ivec2(m.material, 1), 0).rgb;
  return scale.rgb * factored_product(m, int(scale.a) * FACTORED_LAYERS, v, l) + diffuse * l.z;
}
#endif

#endif  // LIMN_FACTORED_RESPONSE_GLSL
