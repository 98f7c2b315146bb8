#include "tests/unit/materials/models.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn::glsl {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Half vectors with the slopes of GGX, whichever the model's are: h seen from v gives l.
DirectionMap halfVectorMap(const dvec2& alpha, const dvec3& v) {
  const auto half = [v](const dvec3& l) {
    const dvec3 sum = v + l;
    return sum / std::max(length(sum), 1e-300);
  };
  DirectionMap map;
  map.direction = [alpha, v](dvec2 u) {
    const double r = std::sqrt(u.x / (1 - u.x)), azimuth = 2 * kPi * u.y;
    const dvec3 h = normalize(dvec3(alpha.x * r * std::cos(azimuth), alpha.y * r * std::sin(azimuth), 1));
    return 2 * dot(v, h) * h - v;
  };
  map.density = [alpha, v, half](dvec3 l) {
    const dvec3 h = half(l);
    const double q = h.x * h.x / (alpha.x * alpha.x) + h.y * h.y / (alpha.y * alpha.y) + h.z * h.z;
    return h.z > 0 ? h.z / (kPi * alpha.x * alpha.y * q * q * 4 * std::max(dot(v, h), 1e-12)) : 0;
  };
  map.place = [alpha, half](dvec3 l) {
    const dvec3 h = half(l);
    const double x = h.x / (alpha.x * h.z), y = h.y / (alpha.y * h.z), r2 = x * x + y * y;
    return dvec2(r2 / (1 + r2), std::atan2(y, x) / (2 * kPi) + (y < 0 ? 1 : 0));
  };
  return map;
}

/// cos^p about r.
DirectionMap powerMap(double p, const dvec3& r) {
  const dvec3 other = std::abs(r.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 t = normalize(cross(other, r)), b = cross(r, t);
  const auto logCosine = [r](const dvec3& l) {
    const dvec3 apart = l - r;
    return std::log1p(-std::min(0.5 * dot(apart, apart), 1.0));
  };
  DirectionMap map;
  map.direction = [=](dvec2 u) {
    const double below = -std::expm1(std::log1p(-u.x) / (p + 1)), azimuth = 2 * kPi * u.y;
    const double sine = std::sqrt(below * (2 - below));
    return sine * std::cos(azimuth) * t + sine * std::sin(azimuth) * b + (1 - below) * r;
  };
  map.density = [=](dvec3 l) { return dot(l, r) > 0 ? (p + 1) / (2 * kPi) * std::exp(p * logCosine(l)) : 0; };
  map.place = [=](dvec3 l) {
    if (!(dot(l, r) > 0)) return dvec2(1, 0);
    const double x = dot(l, t), y = dot(l, b);
    return dvec2(-std::expm1((p + 1) * logCosine(l)), std::atan2(y, x) / (2 * kPi) + (y < 0 ? 1 : 0));
  };
  return map;
}

/// Latitudes about the tangent that lie about the mirrored v's as a Cauchy distribution `width` wide, and
/// longitudes.
DirectionMap coneMap(double width, const dvec3& v) {
  const double centre = -std::asin(std::clamp(v.x, -1.0, 1.0));
  const double from = std::atan((-0.5 * kPi - centre) / width), to = std::atan((0.5 * kPi - centre) / width);
  const auto latitude = [](const dvec3& l) { return std::atan2(l.x, std::hypot(l.y, l.z)); };
  DirectionMap map;
  map.direction = [=](dvec2 u) {
    const double e = centre + width * std::tan(from + u.x * (to - from)), y = 1 - 2 * u.y;
    return dvec3(std::sin(e), std::cos(e) * y, std::cos(e) * std::sqrt(1 - y * y));
  };
  map.density = [=](dvec3 l) {
    const double d = latitude(l) - centre, cosine2 = l.y * l.y + l.z * l.z;
    return width / ((to - from) * (width * width + d * d)) * l.z / (2 * std::max(cosine2, 1e-30));
  };
  map.place = [=](dvec3 l) {
    const double x = (std::atan((latitude(l) - centre) / width) - from) / (to - from);
    return dvec2(x, 0.5 - 0.5 * l.y / std::max(std::hypot(l.y, l.z), 1e-30));
  };
  return map;
}

}  // namespace

DirectionMap cosineMap() {
  DirectionMap map;
  map.direction = [](dvec2 u) {
    const double sine = std::sqrt(u.x), azimuth = 2 * kPi * u.y;
    return dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), std::sqrt(1 - u.x));
  };
  map.density = [](dvec3 l) { return std::max(l.z, 0.0) / kPi; };
  map.place = [](dvec3 l) {
    return dvec2(l.x * l.x + l.y * l.y, std::atan2(l.y, l.x) / (2 * kPi) + (l.y < 0 ? 1 : 0));
  };
  return map;
}

DirectionMap lobeMap(const MaterialModel& m, const vec3& v) {
  switch (m.kind) {
    case model_torrance_sparrow:
      if (v.z > 0) return halfVectorMap(dvec2(std::max(m.roughness.x, 1e-3f)), v);
      return cosineMap();
    case model_ward:
      if (v.z > 0) return halfVectorMap(max(m.roughness, vec2(1e-3f)), v);
      return cosineMap();
    case model_phong:
      return powerMap(m.exponent, dvec3(-v.x, -v.y, v.z));
    case model_banks:
      return coneMap(1 / std::sqrt(1 + double(m.exponent)), v);
    default:
      return cosineMap();
  }
}

void overHemisphere(const MaterialModel& m, const vec3& v, int side,
                    const std::function<void(const vec3&, double)>& add) {
  const DirectionMap maps[] = {lobeMap(m, v), cosineMap()};
  for (const DirectionMap& map : maps)
    for (int i = 0; i < side * side; ++i) {
      const dvec3 exact = map.direction({(i % side + 0.5) / side, (i / side + 0.5) / side});
      const vec3 l(exact);
      if (!(l.z > 0)) continue;
      add(l, 1 / ((maps[0].density(exact) + maps[1].density(exact)) * side * side));
    }
}

double furnace(const MaterialModel& m, const vec3& v, int side) {
  double sum = 0;
  overHemisphere(m, v, side,
                 [&](const vec3& l, double weight) { sum += weight * double(model_response(m, v, l).x); });
  return sum;
}

std::vector<NamedModel> allModels() {
  std::vector<NamedModel> all;
  const auto add = [&](const char* name, float width, const MaterialModel& m) {
    all.push_back({fmt::format("{} {}", name, width), m});
  };
  constexpr uint kBoth = model_option_gaussian | model_option_product;
  for (const float m : {1e-3f, 0.01f, 0.1f, 0.4f, 1.f}) {
    add("torrance_sparrow", m, microfacets(model_torrance_sparrow, vec2(m)));
    add("ward along", m, microfacets(model_ward, vec2(m, 0.5f)));
  }
  for (const float m : {1e-3f, 0.2f, 1.f}) {
    add("gaussian", m, microfacets(model_torrance_sparrow, vec2(m), model_option_gaussian));
    add("gaussian product", m, microfacets(model_torrance_sparrow, vec2(m), kBoth));
    add("ward across product", m, microfacets(model_ward, vec2(0.2f, m), model_option_product));
    MaterialModel plastic = microfacets(model_torrance_sparrow, vec2(m));
    plastic.eta = vec3(1.5f);
    plastic.k = vec3(0);
    plastic.kd = vec3(0.5f);
    add("plastic", m, plastic);
  }
  for (const float p : {0.f, 1.f, 10.f, 1000.f, 1e5f}) {
    add("phong", p, phongModel(0, 1, p));
    add("phong floor", p, phongModel(0.3f, 0.7f, p));
  }
  for (const float p : {0.f, 10.f, 1000.f})
    for (const uint options : {0u, model_option_printed})
      for (const float diffuse : {0.f, 1.f}) {
        MaterialModel m = banksModel(diffuse, 1, p, options);
        const float excess = model_excess(m);
        m.kd /= excess;
        m.ks /= excess;
        add(options == 0 ? "banks stalling" : "banks printed", p, m);
      }
  add("banks diffuse", 1, banksModel(0.375f, 0, 1));
  for (const float eta : {1.f, 1.0001f, 1.5f, 200.f})
    for (const uint options : {0u, model_option_blend, model_option_physical})
      add("coated", eta, coatedModel(0.8f, eta, options));
  return all;
}

}  // namespace limn::glsl
