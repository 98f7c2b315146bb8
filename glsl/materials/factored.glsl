// BRDFs factored into tables of few dimensions: where in its table each factor is looked up, and the product. Every
// function returns f n.l, 1/sr, as the tables hold it: the cosine that f divides by cancels.
//
// A place is a point of [0, 1]^2 (or ^3); 0 and 1 are the centres of the first and the last texel, so that both ends of
// a coordinate are met. Tables are filtered linearly and clamped to the edge.
//
// Two tables (McCool, Ang and Ahmad 2001; Heidrich and Seidel 1999): f n.l = T1(h.l, n.h) T2(n.l, n.v), where T1 holds
// Fresnel's term times the distribution of normals, and T2 masking over 4 n.v. In published coordinates they lie over
// the cosines. A lobe of width m is m^2 wide in n.h, but m in sqrt(1 - n.h), which warped tables lie over: their error
// is 0.4 / (N m)^2 for N texels where the cosines' is 0.33 / (N m^2)^2.
#ifndef LIMN_FACTORED_GLSL
#define LIMN_FACTORED_GLSL
#include "glsl/numeric/language.glsl"

// A table of layers: an array texture in GLSL, core/brdf/factor_tables.h in C++. Those of several BRDFs lie behind each other;
// `first` is the first layer of one.
#ifdef __cplusplus
#include "core/base/export.h"
namespace limn::brdf {
struct FactorTable;
}
namespace limn::glsl {
LIMN_API glm::vec3 factored_lookup(const brdf::FactorTable& table, glm::vec2 place, int layer);
}  // namespace limn::glsl
#define FACTORED_TABLE const brdf::FactorTable&
#else
#define FACTORED_TABLE sampler2DArray
#endif

LIMN_BEGIN

// Texture coordinates of a place in a table of `size` texels.
LIMN_FN vec2 factored_coordinates(vec2 place, vec2 size) {
  return (place * (size - vec2(1.0f)) + vec2(0.5f)) / size;
}

#ifndef __cplusplus
vec3 factored_lookup(sampler2DArray table, vec2 place, int layer) {
  return textureLod(table, vec3(factored_coordinates(place, vec2(textureSize(table, 0).xy)), float(layer)), 0.0).rgb;
}
#endif

// What isotropic factors depend on, each in [0, 1].
struct FactoredAngles {
  float n_dot_l;
  float n_dot_v;
  float l_dot_h;
  float h_from_n;  // sqrt(1 - n.h)
};

// The half vector; n where l = -v.
LIMN_FN vec3 factored_half(vec3 n, vec3 v, vec3 l) {
  vec3 sum = v + l;
  float size = length(sum);
  return size > 1e-6f ? sum / size : n;
}

// sqrt(1 - n.h) is taken as |n - h| / sqrt(2): 1 - n.h has lost its digits where the lobe is.
LIMN_FN FactoredAngles factored_angles(vec3 n, vec3 v, vec3 l) {
  vec3 h = factored_half(n, v, l);
  FactoredAngles a;
  a.n_dot_l = clamp(dot(n, l), 0.0f, 1.0f);
  a.n_dot_v = clamp(dot(n, v), 0.0f, 1.0f);
  a.l_dot_h = clamp(dot(l, h), 0.0f, 1.0f);
  a.h_from_n = min(length(n - h) * 0.70710678f, 1.0f);
  return a;
}

// Places in the two tables.
LIMN_FN vec2 factored_place_1(FactoredAngles a, bool warped) {
  return vec2(a.l_dot_h, warped ? 1.0f - a.h_from_n : 1.0f - a.h_from_n * a.h_from_n);
}
LIMN_FN vec2 factored_place_2(FactoredAngles a, bool warped) {
  vec2 cosines = vec2(a.n_dot_l, a.n_dot_v);
  return warped ? sqrt(cosines) : cosines;
}

// Two tables. What a fit left as a diffuse floor, the caller adds.
LIMN_FN vec3 factored_response(FACTORED_TABLE t1, FACTORED_TABLE t2, int layer, FactoredAngles a, bool warped) {
  return factored_lookup(t1, factored_place_1(a, warped), layer) * factored_lookup(t2, factored_place_2(a, warped), layer);
}

// Places in the rows of one-dimensional factors: the distribution's over n.h, Fresnel's over h.l, masking's over n.l
// or n.v. `cosine_place` of 0 has an infinite slope, as masking and Fresnel's term are steep at grazing angles.
LIMN_FN float factored_half_place(FactoredAngles a) { return 1.0f - a.h_from_n; }
LIMN_FN float factored_cosine_place(float cosine) { return sqrt(cosine); }

// log f = D(n.h) + F(h.l) + G(n.l) + G(n.v), or f as the sum of `terms` such products, a layer of `logs` each: its rows are
// D, F and G, natural logarithms of f in 1/sr.
LIMN_FN vec3 factored_dfg_response(FACTORED_TABLE logs, int first, int terms, FactoredAngles a) {
  vec3 f = vec3(0.0f);
  for (int k = first; k < first + terms; ++k) {
    f += exp(factored_lookup(logs, vec2(factored_half_place(a), 0.0f), k) +
             factored_lookup(logs, vec2(factored_cosine_place(a.l_dot_h), 0.5f), k) +
             factored_lookup(logs, vec2(factored_cosine_place(a.n_dot_l), 1.0f), k) +
             factored_lookup(logs, vec2(factored_cosine_place(a.n_dot_v), 1.0f), k));
  }
  return f * a.n_dot_l;
}

// Homomorphic factorisation (McCool, Ang and Ahmad 2001) of isotropic BRDFs, log f = p(n.l) + q(n.h) + p(n.v), or a sum of
// such products: the rows of `logs` are p and q.
LIMN_FN vec3 factored_pqp_response(FACTORED_TABLE logs, int first, int terms, FactoredAngles a) {
  vec3 f = vec3(0.0f);
  for (int k = first; k < first + terms; ++k) {
    f += exp(factored_lookup(logs, vec2(factored_cosine_place(a.n_dot_l), 0.0f), k) +
             factored_lookup(logs, vec2(factored_half_place(a), 1.0f), k) +
             factored_lookup(logs, vec2(factored_cosine_place(a.n_dot_v), 0.0f), k));
  }
  return f * a.n_dot_l;
}

// Place of a direction of the upper hemisphere (local frame) in a paraboloid's disc. Warped, the disc's radius is
// replaced by its square root, which gives the texels to the directions around n.
LIMN_FN vec2 factored_disc_place(vec3 direction, bool warped) {
  vec2 disc = vec2(direction.x, direction.y) / (1.0f + max(direction.z, 0.0f));
  float radius = length(disc);
  if (warped && radius > 0.0f) disc = disc / sqrt(radius);
  return clamp(0.5f * disc + vec2(0.5f), vec2(0.0f), vec2(1.0f));
}

// p(l) + q(h) + p(v) of BRDFs that turn with the tangent, over directions: two layers of `logs` from `first` on, p and q.
LIMN_FN vec3 factored_disc_logs(FACTORED_TABLE logs, int first, vec3 v, vec3 l, vec3 h, bool warped) {
  return factored_lookup(logs, factored_disc_place(l, false), first) +
         factored_lookup(logs, factored_disc_place(h, warped), first + 1) +
         factored_lookup(logs, factored_disc_place(v, false), first);
}

// f n.l as the sum of `terms` such products, two layers each. Local frame.
LIMN_FN vec3 factored_pqp_disc_response(FACTORED_TABLE logs, int first, int terms, vec3 v, vec3 l, bool warped) {
  vec3 h = factored_half(vec3(0.0f, 0.0f, 1.0f), v, l);
  vec3 f = vec3(0.0f);
  for (int k = 0; k < terms; ++k) f += exp(factored_disc_logs(logs, first + 2 * k, v, l, h, warped));
  return f * max(l.z, 0.0f);
}

// The same with a further factor F(h.l), whose rows are layers of `rows`: one for every two of `discs`.
LIMN_FN vec3 factored_dfg_disc_response(FACTORED_TABLE discs, FACTORED_TABLE rows, int first, int terms, vec3 v, vec3 l,
                                        bool warped) {
  vec3 h = factored_half(vec3(0.0f, 0.0f, 1.0f), v, l);
  vec2 fresnel_place = vec2(factored_cosine_place(clamp(dot(l, h), 0.0f, 1.0f)), 0.0f);
  vec3 f = vec3(0.0f);
  for (int k = 0; k < terms; ++k) {
    f += exp(factored_disc_logs(discs, first + 2 * k, v, l, h, warped) + factored_lookup(rows, fresnel_place, first / 2 + k));
  }
  return f * max(l.z, 0.0f);
}

// The light's direction as seen from the half vector (Rusinkiewicz 1998, A New Change of Variables for Efficient BRDF
// Representation): h turned to +z about the axis across n and h. Local frame.
LIMN_FN vec3 factored_difference(vec3 h, vec3 l) {
  float across = length(vec2(h.x, h.y));
  vec2 azimuth = across > 1e-6f ? vec2(h.x, h.y) / across : vec2(1.0f, 0.0f);
  float along = l.x * azimuth.x + l.y * azimuth.y;
  float side = l.y * azimuth.x - l.x * azimuth.y;
  return vec3(along * h.z - l.z * across, side, along * across + l.z * h.z);
}

// Half vector and difference (Kautz and McCool 1999, Interactive Rendering with Arbitrary BRDFs using Separable
// Approximations): f n.l as the sum of `terms` products of a layer of `halves` and the same of `differences`.
LIMN_FN vec3 factored_svd_response(FACTORED_TABLE halves, FACTORED_TABLE differences, int first, int terms, vec3 v, vec3 l) {
  vec3 h = factored_half(vec3(0.0f, 0.0f, 1.0f), v, l);
  vec2 half_place = factored_disc_place(h, true);
  vec2 difference_place = factored_disc_place(factored_difference(h, l), false);
  vec3 sum = vec3(0.0f);
  for (int k = first; k < first + terms; ++k) {
    sum += factored_lookup(halves, half_place, k) * factored_lookup(differences, difference_place, k);
  }
  return max(sum, vec3(0.0f)) * max(l.z, 0.0f);
}

// Place of a pair of directions in a table of an isotropic BRDF over half vector and difference: the half vector's angle
// warped once more than factors' is, as measured data are kept, then angle and azimuth of l about h. The azimuth is
// folded into [0, pi / 2]: isotropic reciprocal BRDFs that equal their mirror image repeat there.
LIMN_FN vec3 factored_volume_place(vec3 v, vec3 l) {
  vec3 n = vec3(0.0f, 0.0f, 1.0f);
  vec3 h = factored_half(n, v, l);
  vec3 d = factored_difference(h, l);
  float across = length(vec2(d.x, d.y));
  float azimuth = across > 1e-6f ? 2.0f * inverse_pi * atan(abs(d.y), abs(d.x)) : 0.0f;
  float polar = 2.0f * inverse_pi * atan(across, max(d.z, 0.0f));
  return vec3(1.0f - sqrt(min(length(n - h) * 0.70710678f, 1.0f)), min(polar, 1.0f), min(azimuth, 1.0f));
}

// The table's slices over the azimuth are layers, between which this interpolates: several volumes share an array.
LIMN_FN vec3 factored_volume_response(FACTORED_TABLE table, int first, int slices, vec3 v, vec3 l) {
  vec3 place = factored_volume_place(v, l);
  float along = place.z * float(slices - 1);
  int low = min(int(along), slices - 2);
  return mix(factored_lookup(table, vec2(place), first + low), factored_lookup(table, vec2(place), first + low + 1),
             along - float(low)) *
         max(l.z, 0.0f);
}

// Ward's elliptical Gaussian turns with the tangent: D over the half vector's components along the tangent and across it.
// By their square roots a lobe of width m is as wide as sqrt(m) in each; published: over the angle to n and the azimuth.
LIMN_FN vec2 factored_slope_place(vec3 h, bool warped) {
  vec2 along = abs(vec2(h.x, h.y));
  if (warped) return min(sqrt(along), vec2(1.0f));
  // At h = n, where no azimuth is, D is the same for all.
  return 2.0f * inverse_pi * vec2(atan(length(along), max(h.z, 0.0f)), atan(along.y, max(along.x, 1e-20f)));
}

// n.w times Smith's Lambda, which is finite at grazing angles. Over `reach`, the length of n.w and the spread of slopes along
// w's azimuth, it is a function of one ratio: the second row of `rows`.
LIMN_FN float factored_cosine_lambda(FACTORED_TABLE rows, int layer, vec2 alpha, vec3 w) {
  float cosine = max(w.z, 0.0f);
  float reach = max(length(vec3(alpha * vec2(w), cosine)), 1e-6f);
  return reach * factored_lookup(rows, vec2(cosine / reach, 1.0f), layer).x;
}

// f n.l = F D G / (4 n.v) from D's table, and the rows of Fresnel's term over h.l and of masking. alpha: the roughness along the
// tangent and across it. independent: G is the product of both directions' masking. Local frame; l above the horizon.
LIMN_FN vec3 factored_slopes_response(FACTORED_TABLE distribution, FACTORED_TABLE rows, int layer, vec2 alpha,
                                      bool independent, vec3 v, vec3 l, bool warped) {
  vec3 h = factored_half(vec3(0.0f, 0.0f, 1.0f), v, l);
  if (!(l.z > 0.0f && h.z > 0.0f)) return vec3(0.0f);
  float n_dot_v = max(v.z, 0.0f);
  float from_v = factored_cosine_lambda(rows, layer, alpha, v);
  float from_l = factored_cosine_lambda(rows, layer, alpha, l);
  float both = n_dot_v * (l.z + from_l) + l.z * from_v + (independent ? from_l * from_v : 0.0f);
  vec3 fresnel = factored_lookup(rows, vec2(factored_cosine_place(clamp(dot(l, h), 0.0f, 1.0f)), 0.0f), layer);
  return factored_lookup(distribution, factored_slope_place(h, warped), layer) * fresnel *
         (0.25f * l.z / max(both, 1e-30f));
}

// Fibres along the tangent (Banks 1994; Stalling, Zoeckler and Hege 1997) reflect by l.t and v.t alone. Local frame.
LIMN_FN vec3 factored_fibres_response(FACTORED_TABLE table, int layer, vec3 v, vec3 l) {
  vec2 place = clamp(vec2(0.5f) + 0.5f * vec2(l.x, v.x), vec2(0.0f), vec2(1.0f));
  return factored_lookup(table, place, layer) * max(l.z, 0.0f);
}

LIMN_END
#endif  // LIMN_FACTORED_GLSL
