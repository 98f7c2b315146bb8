#include "tests/unit/materials/models.h"

#include <fmt/format.h>

#include <algorithm>

#include "glsl/numeric/sampling.glsl"

namespace limn::glsl {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Half vectors whose slopes over alpha have the length s / (1 - s) for s uniform in [0, 1): enough of them
/// far out for every tail that is seen at a grazing angle.
DirectionMap halfVectorMap(const dvec2& alpha, const dvec3& v) {
  const auto half = [v](const dvec3& l) {
    const dvec3 sum = v + l;
    return sum / std::max(length(sum), 1e-300);
  };
  const auto slope = [alpha](const dvec3& h) { return dvec2(h.x, h.y) / (alpha * h.z); };
  DirectionMap map;
  map.direction = [alpha, v](dvec2 u) {
    const double r = u.x / (1 - u.x), azimuth = 2 * kPi * u.y;
    const dvec3 h = normalize(dvec3(alpha.x * r * std::cos(azimuth), alpha.y * r * std::sin(azimuth), 1));
    return 2 * dot(v, h) * h - v;
  };
  map.density = [alpha, v, half, slope](dvec3 l) {
    const dvec3 h = half(l);
    if (!(h.z > 0)) return 0.0;
    const double r = std::max(length(slope(h)), 1e-12);
    const double ofSlopes = 1 / (2 * kPi * r * (1 + r) * (1 + r) * alpha.x * alpha.y);
    return ofSlopes / (h.z * h.z * h.z * 4 * std::max(dot(v, h), 1e-12));
  };
  map.place = [half, slope](dvec3 l) {
    const dvec2 at = slope(half(l));
    const double r = length(at);
    return dvec2(r / (1 + r), std::atan2(at.y, at.x) / (2 * kPi) + (at.y < 0 ? 1 : 0));
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
    if (!(l.z > 0)) return 0.0;
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
    case model_measured:
      return halfVectorMap(dvec2(std::max(m.roughness.x, 1e-3f)), v);
    case model_ward:
      return halfVectorMap(max(m.roughness, vec2(1e-3f)), v);
    case model_phong:
      return powerMap(m.exponent, dvec3(-v.x, -v.y, v.z));
    case model_banks:
      return coneMap(1 / std::sqrt(1 + double(m.exponent)), v);
    default:
      return cosineMap();
  }
}

void overHemisphere(const MaterialModel& m, const vec3& v, int count,
                    const std::function<void(const vec3&, double)>& add) {
  const DirectionMap maps[] = {lobeMap(m, v), cosineMap()};
  for (int own = 0; own < 2; ++own)
    for (int i = 0; i < count; ++i) {
      const dvec3 exact = maps[own].direction(dvec2(r2_sequence(uint(i))));
      const vec3 l(exact);
      const double density = maps[own].density(exact), other = maps[1 - own].density(exact);
      if (l.z > 0 && density > 0) add(l, density / ((density * density + other * other) * count));
    }
}

double furnace(const MaterialModel& m, const vec3& v, int count) {
  double sum = 0;
  overHemisphere(m, v, count,
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
