// L_u of a surface whose material has a model: what one unoccluded light adds to the radiance that leaves it. Punctual lights:
// the response itself. A rectangle: its mean over model_light_side^2 points, of which those below a horizon give nothing.
#ifndef LIMN_MODEL_LIGHT_GLSL
#define LIMN_MODEL_LIGHT_GLSL
#include "glsl/light/unshadowed_light.glsl"
#include "glsl/materials/response.glsl"
#include "glsl/numeric/sampling.glsl"
LIMN_BEGIN

LIMN_CONST int model_light_side = 4;  // points along each side of a rectangle

// One of the points that stand for a rectangle.
struct RectangleSample {
  vec3 l;        // unit, towards the point
  float weight;  // solid angle that the rectangle would have, were it all there; 0: below the horizon of ng
};

LIMN_FN RectangleSample rectangle_sample(Rectangle r, vec3 ng, int i) {
  RectangleSample s;
  vec3 offset = rectangle_point(r, grid_point(i, model_light_side) - vec2(0.5f));
  float d2 = dot(offset, offset);
  s.l = offset * inversesqrt(d2 > 0.0f ? d2 : 1.0f);
  s.weight = d2 > 0.0f && dot(ng, s.l) > 0.0f ? abs(dot(cross(r.u, r.v), s.l)) / d2 : 0.0f;
  return s;
}

// Reflected radiance per unit of the rectangle's radiance. Arguments: as unshadowed_rectangle() has them.
LIMN_FN vec3 model_rectangle(Rectangle r, MaterialModel m, Frame frame, vec3 ng, vec3 v) {
  vec3 sum = vec3(0.0f);
  vec3 to_viewer = to_local(frame, v);
  for (int i = 0; i < model_light_side * model_light_side; ++i) {
    RectangleSample s = rectangle_sample(r, ng, i);
    if (s.weight > 0.0f) sum += material_response(m, to_viewer, to_local(frame, s.l)) * s.weight;
  }
  return sum / float(model_light_side * model_light_side);
}

#if (MATERIAL_MODELS & 128) != 0
// The same of what enters a translucent surface: the exact irradiance, times the mean of F_t over the points.
LIMN_FN vec3 entering_rectangle(Rectangle r, MaterialModel m, Frame frame, vec3 ng, vec3 v) {
  float all = 0.0f;
  float entering = 0.0f;
  for (int i = 0; i < model_light_side * model_light_side; ++i) {
    RectangleSample s = rectangle_sample(r, ng, i);
    float cosine = max(dot(frame.n, s.l), 0.0f);
    all += cosine * s.weight;
    entering += cosine * s.weight * entry_share(m, cosine);
  }
  SurfaceBrdf white = surface_brdf(vec3(1.0f), 0.0f, 1.0f, 0.0f, vec3(1.0f), m.eta.x);
  return unshadowed_rectangle(r, white, frame.n, ng, v) * (all > 0.0f ? entering / all : m.kd.x);
}
#endif

// As unshadowed_light(), for a model in its frame, whose n is the shading normal.
LIMN_FN vec3 model_light(Light light, MaterialModel m, Frame frame, vec3 p, vec3 ng, vec3 v) {
  bool distant = light_is_distant_rectangle(light) && (light.flags & light_flag_centre) == 0u;
  if (light.type == light_rectangle || distant) {
    if (!rectangle_emits_towards(light, p)) return vec3(0.0f);
    float factor = receiver_factor(light, p);
    if (factor == 0.0f) return vec3(0.0f);
    Rectangle r = rectangle_from(light, p);
#if (MATERIAL_MODELS & 128) != 0
    if (m.kind == model_entry) return rectangle_radiance(light) * (factor * entering_rectangle(r, m, frame, ng, v));
#endif
    return rectangle_radiance(light) * (factor * model_rectangle(r, m, frame, ng, v));
  }
  vec3 l = punctual_direction(light, p);
  if (!(dot(frame.n, l) > 0.0f) || dot(ng, l) <= 0.0f) return vec3(0.0f);
  return material_response(m, to_local(frame, v), to_local(frame, l)) * punctual_irradiance(light, p);
}

LIMN_END
#endif  // LIMN_MODEL_LIGHT_GLSL
