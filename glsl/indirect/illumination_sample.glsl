// Illumination samples: small area lights that links leave at the elements they light (Stamminger, Scheel, Granier,
// Perez-Cazorla, Drettakis and Sillion 1999, Efficient Glossy Global Illumination with Interactive Viewing).
#ifndef LIMN_ILLUMINATION_SAMPLE_GLSL
#define LIMN_ILLUMINATION_SAMPLE_GLSL
#include "glsl/geometry/vertex.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Element of a storage buffer, 16 bytes.
struct IlluminationSample {
  vec3 radiance;  // g, the mean of radiance times visibility over the link, W/(m^2 sr)
  uint sender;    // which SampleSender
};

// The place of a sample's light. Element of a storage buffer, 32 bytes.
struct SampleSender {
  vec3 position;  // y, in the units of the elements
  float area;     // A, in those units squared
  vec3 side;      // one side of a rectangle of that area that lies as the sender does
  uint normal;    // n: vertex_pack_normal
};

// What arrives of a sample at a point. Nothing arrives behind the sample.
struct IncidentLight {
  vec3 direction;   // w, unit, towards the sample
  float spread;     // delta, about the sample's extent, rad
  vec3 irradiance;  // E, on a surface that faces it, W/m^2
};

// The widest sample that a single direction stands for, rad.
LIMN_CONST float incident_max_spread = 1.5f;

// The irradiance, per unit of radiance, that a disc gives a point on its axis, on a surface that faces it: A c / (d^2 + A c / pi),
// at most pi. `cosine`: c, at the disc, as it turns away from the point; `distance2`: d^2.
LIMN_FN float axis_transport(float area, float cosine, float distance2) {
  float shown = area * cosine;
  return shown > 0.0f ? shown / (distance2 + inverse_pi * shown) : 0.0f;
}

// About the angle that a sender spans, rad.
LIMN_FN float sender_spread(float area, float distance2) {
  return area >= incident_max_spread * incident_max_spread * distance2 ? incident_max_spread : sqrt(area / distance2);
}

// The sample is taken as a disc on whose axis the point lies. `radiance`: g; `x`: the point.
LIMN_FN IncidentLight incident_light(SampleSender s, vec3 radiance, vec3 x) {
  vec3 way = s.position - x;
  float distance2 = dot(way, way);
  IncidentLight r;
  r.direction = way / sqrt(max(distance2, 1e-30f));
  r.irradiance = radiance * axis_transport(s.area, -dot(r.direction, vertex_unpack_normal(s.normal)), distance2);
  r.spread = sender_spread(s.area, distance2);
  return r;
}

// The GGX width of the lobe that stands for a surface of width alpha lit by a light of some spread at the cosine n_dot_l;
// `widen`: standard deviations of the light per spread, about. Half vectors spread as the light does along its plane of
// incidence, and 1 / n_dot_l times as much across: an isotropic lobe takes the geometric mean. Without it every light shows
// as a highlight of its own.
LIMN_FN float widened_alpha(float alpha, float spread, float n_dot_l, float widen) {
  float by = widen * spread / sqrt(max(n_dot_l, 0.1f));
  return min(sqrt(alpha * alpha + by * by), 1.0f);
}

LIMN_END
#endif  // LIMN_ILLUMINATION_SAMPLE_GLSL
