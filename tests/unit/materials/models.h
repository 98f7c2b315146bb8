// Material models for tests, and integrals over the directions that light comes from. The integrals are
// written in double precision and share no code with glsl/materials.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "glsl/materials/model.glsl"

namespace limn::glsl {

inline vec3 directionAt(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {float(sine * std::cos(azimuth)), float(sine * std::sin(azimuth)), float(cosine)};
}

/// A model of one kind that reflects everything: lobe alone, without losses at the interface.
inline MaterialModel whiteModel(uint kind) {
  MaterialModel m{};
  m.kind = kind;
  m.eta = vec3(1e-3f);  // |F - 1| < 1e-5
  m.k = vec3(1000);
  m.exponent = 32;
  m.ks = vec3(1);
  m.roughness = vec2(0.3f);
  return m;
}

inline MaterialModel microfacets(uint kind, vec2 roughness, uint options = 0) {
  MaterialModel m = whiteModel(kind);
  m.roughness = roughness;
  m.options = options;
  return m;
}

inline MaterialModel phongModel(float kd, float ks, float exponent) {
  MaterialModel m = whiteModel(model_phong);
  m.kd = vec3(kd);
  m.ks = vec3(ks);
  m.exponent = exponent;
  return m;
}

inline MaterialModel banksModel(float kd, float ks, float exponent, uint options = 0) {
  MaterialModel m = phongModel(kd, ks, exponent);
  m.kind = model_banks;
  m.options = options;
  return m;
}

inline MaterialModel coatedModel(float kd, float eta, uint options) {
  MaterialModel m = whiteModel(model_coated);
  m.kd = vec3(kd);
  m.eta = vec3(eta);
  m.k = vec3(0);
  m.options = options;
  return m;
}

struct NamedModel {
  std::string name;
  MaterialModel model;
};

/// Every model with each of its options, from the narrowest lobe to the widest; kd and ks within what energy
/// allows.
std::vector<NamedModel> allModels();

/// A map from the unit square to directions, with its density over solid angle and its inverse.
struct DirectionMap {
  std::function<dvec3(dvec2)> direction;
  std::function<double(dvec3)> density;
  std::function<dvec2(dvec3)> place;
};

DirectionMap cosineMap();
/// Returns the map whose points are dense where the model's lobe seen from `v` is.
DirectionMap lobeMap(const MaterialModel& m, const vec3& v);

/// Calls `add(l, weight)` for directions of the upper hemisphere such that the sum of weight f(l) is the
/// integral of f over solid angle. `count` points of each map are combined by the power heuristic, so that f
/// may have a narrow lobe; a low-discrepancy sequence keeps the horizon's cut out of step with them.
void overHemisphere(const MaterialModel& m, const vec3& v, int count,
                    const std::function<void(const vec3&, double)>& add);

/// Returns the integral of the response: the share of uniform light that is reflected towards `v`, in the
/// first channel.
double furnace(const MaterialModel& m, const vec3& v, int count = 25000);

}  // namespace limn::glsl
