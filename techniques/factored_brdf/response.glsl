// Torrance-Sparrow as T1(h.l, n.h) T2(n.l, n.v) (glsl/materials/factored.glsl); other models exactly. FACTORED_WARPED: what
// the tables lie over.
#ifndef LIMN_FACTORED_RESPONSE_GLSL
#define LIMN_FACTORED_RESPONSE_GLSL
#include "glsl/materials/factored.glsl"
#include "glsl/materials/model.glsl"

uniform sampler2DArray factored_1;
uniform sampler2DArray factored_2;
uniform sampler2D factored_layers;  // of each material: rgb: factor; a: layer of its tables

vec3 material_response(MaterialModel m, vec3 v, vec3 l) {
  if (m.kind != model_torrance_sparrow) return model_response(m, v, l);
  if (!(l.z > 0.0)) return vec3(0.0);
  FactoredAngles a = factored_angles(vec3(0.0, 0.0, 1.0), v, l);
  vec4 layer = texelFetch(factored_layers, ivec2(m.material, 0), 0);
  return m.ks * layer.rgb * factored_lookup_layer(factored_1, factored_place_1(a, FACTORED_WARPED), int(layer.a)) *
             factored_lookup_layer(factored_2, factored_place_2(a, FACTORED_WARPED), int(layer.a)) +
         m.kd * (inverse_pi * l.z);
}

#endif  // LIMN_FACTORED_RESPONSE_GLSL
