// Participating media and the optics of smooth surfaces: transmittance, phase function, Fresnel, reflection and refraction
// (thesis, section 8.2). Directions are unit vectors. Lengths in metres, coefficients per metre.
//
// A medium fills a ball, the bounding sphere of the scene: outside it light travels freely, so that light from infinity and
// views of the background have an optical thickness. Where it is not homogeneous, a density multiplies its coefficients,
// and what is called a length here counts every metre times the density there.
#ifndef LIMN_MEDIA_GLSL
#define LIMN_MEDIA_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

struct Ball {
  vec3 centre;
  float radius;
};

struct Medium {
  vec3 extinction;  // sigma_a + sigma_s
  vec3 scattering;  // sigma_s
  float g;          // mean cosine of the phase function, -1 < g < 1; > 0: forward
  Ball ball;        // what it fills
};

// Where the ray origin + t direction is in the ball: t in [x, y]; x > y where it misses.
LIMN_FN vec2 ball_range(Ball ball, vec3 origin, vec3 direction) {
  vec3 offset = origin - ball.centre;
  float nearest = -dot(offset, direction);
  vec3 across = offset + nearest * direction;
  float square = ball.radius * ball.radius - dot(across, across);
  if (!(square > 0.0f)) return vec2(1.0f, -1.0f);
  float half_chord = sqrt(square);
  return vec2(nearest - half_chord, nearest + half_chord);
}

// Where it is in the unit cube, likewise; origin and direction in the cube's space.
LIMN_FN vec2 unit_box_range(vec3 origin, vec3 direction) {
  vec2 range = vec2(-3.0e38f, 3.0e38f);
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0f) {
      if (!(origin[axis] > 0.0f && origin[axis] < 1.0f)) return vec2(1.0f, -1.0f);
      continue;
    }
    float a = -origin[axis] / direction[axis];
    float b = (1.0f - origin[axis]) / direction[axis];
    range = vec2(max(range.x, min(a, b)), min(range.y, max(a, b)));
  }
  return range;
}

// Length of the piece of the ray with 0 < t < end that lies in the ball.
LIMN_FN float ball_length(Ball ball, vec3 origin, vec3 direction, float end) {
  vec2 range = ball_range(ball, origin, direction);
  return max(min(range.y, end) - max(range.x, 0.0f), 0.0f);
}

// The same between two points.
LIMN_FN float ball_length_between(Ball ball, vec3 a, vec3 b) {
  vec3 d = b - a;
  float size = length(d);
  return size > 0.0f ? ball_length(ball, a, d / size, size) : 0.0f;
}

// tau over a length inside the medium.
LIMN_FN vec3 medium_transmittance(Medium m, float length_inside) {
  return vec3(exp(-m.extinction.x * length_inside), exp(-m.extinction.y * length_inside),
              exp(-m.extinction.z * length_inside));
}

// Henyey and Greenstein 1941, 1/sr; `from`: direction in which the light travels, `to`: in which it goes on. The textbook
// form loses 6e-4 at g = 0.99 in float; here 1 - cos comes from the difference of the directions.
LIMN_FN float phase_function(float g, vec3 from, vec3 to) {
  float a = abs(g);
  vec3 away = g >= 0.0f ? from - to : from + to;
  float denominator = (1.0f - a) * (1.0f - a) + a * dot(away, away);
  return (1.0f - a * a) / (4.0f * pi * denominator * sqrt(denominator));
}

// The mirror direction; l and the result point away from the surface.
LIMN_FN vec3 mirrored(vec3 l, vec3 n) { return 2.0f * dot(n, l) * n - l; }

// The refracted direction, pointing away from the surface to the other side; l points away from the surface on n's side,
// e = n1 / n2. 0 at total internal reflection.
LIMN_FN vec3 refracted(vec3 l, vec3 n, float e) {
  float c = dot(n, l);
  float radicand = 1.0f - e * e * (1.0f - c * c);
  if (!(radicand > 0.0f)) return vec3(0.0f);
  return (e * c - sqrt(radicand)) * n - e * l;
}

// Unpolarised reflectance of a smooth interface between dielectrics; cosine: of the angle of incidence on the side of n1.
// 1 at total internal reflection.
LIMN_FN float fresnel_reflectance(float cosine, float n1, float n2) {
  float sine2 = max(1.0f - cosine * cosine, 0.0f) * (n1 / n2) * (n1 / n2);
  if (sine2 >= 1.0f) return 1.0f;
  float other = sqrt(1.0f - sine2);
  float parallel = (n2 * cosine - n1 * other) / (n2 * cosine + n1 * other);
  float perpendicular = (n1 * cosine - n2 * other) / (n1 * cosine + n2 * other);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// A specular surface (glTF's metallic, transmission, ior and volume).
struct Optics {
  vec3 base;
  float metallic;
  float transmission;
  float ior;
  float thickness;             // m; 0: a thin wall, which does not bend light
  vec3 attenuation;            // of light inside, over attenuation_distance
  float attenuation_distance;  // m; 0: clear
};

// Share of flux that is mirrored: metals by Schlick's approximation, else Fresnel.
LIMN_FN vec3 optics_reflectance(Optics o, float cosine, float n1, float n2) {
  float rest = 1.0f - clamp(cosine, 0.0f, 1.0f);
  float weight = rest * rest * rest * rest * rest;
  vec3 metal = o.base + (vec3(1.0f) - o.base) * weight;
  float dielectric = fresnel_reflectance(cosine, n1, n2);
  return vec3(dielectric) + (metal - vec3(dielectric)) * o.metallic;
}

// Share of flux that passes one interface, tinted by the base colour.
LIMN_FN vec3 optics_transmittance(Optics o, float cosine, float n1, float n2) {
  return o.base * (o.transmission * (1.0f - o.metallic) * (1.0f - fresnel_reflectance(cosine, n1, n2)));
}

// What a body leaves over a length inside it, of which it leaves `attenuation` over attenuation_distance (0: it is clear). Over
// 1e10 such distances nothing is left of any colour below 1. Their number may exceed all floats, and GLSL defines no such power
// of 1, which is what white glass leaves.
LIMN_FN vec3 body_absorption(vec3 attenuation, float attenuation_distance, float length_inside) {
  if (!(attenuation_distance > 0.0f)) return vec3(1.0f);
  float exponent = min(length_inside / attenuation_distance, 1e10f);
  vec3 colour = max(attenuation, vec3(1e-6f));
  return vec3(pow(colour.x, exponent), pow(colour.y, exponent), pow(colour.z, exponent));
}
LIMN_FN vec3 optics_absorption(Optics o, float length_inside) {
  return body_absorption(o.attenuation, o.attenuation_distance, length_inside);
}

LIMN_END
#endif  // LIMN_MEDIA_GLSL
