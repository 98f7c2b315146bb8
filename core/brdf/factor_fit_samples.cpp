#include "core/brdf/factor_fit_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "glsl/numeric/halton.glsl"

namespace limn::brdf {
namespace {

using glm::dvec3;

dvec3 direction(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

}  // namespace

bool finite(const dvec3& f) {
  return std::isfinite(f.x) && std::isfinite(f.y) && std::isfinite(f.z);
}

void directionsOf(const dvec3& h, const dvec3& difference, dvec3& l, dvec3& v) {
  const double across = std::hypot(h.x, h.y);
  const double x = across > 1e-9 ? h.x / across : 1, y = across > 1e-9 ? h.y / across : 0;
  const auto turned = [&](const dvec3& d) {  // by the angle of h about the y axis, then by its azimuth
    const double along = d.x * h.z + d.z * across;
    return dvec3(along * x - d.y * y, along * y + d.y * x, d.z * h.z - d.x * across);
  };
  l = turned(difference);
  v = turned({-difference.x, -difference.y, difference.z});
}

std::vector<BrdfSample> sampleBrdf(const Brdf& brdf, int count) {
  if (!brdf) throw Error("there is no BRDF to fit");
  std::vector<BrdfSample> samples;
  bool positive = false;
  constexpr double kTurn = 2 * std::numbers::pi;
  // Half vectors are tried twice as often: from half of them, roughly, l or v would lie below the horizon.
  for (int i = 1; i <= count + count / 2; ++i) {
    const auto index = static_cast<unsigned>(i);
    const dvec3 u(glsl::halton_point(index));
    const double turn = kTurn * static_cast<double>(glsl::radical_inverse(7, index));
    dvec3 l, v;
    if (i % 3 != 0) {
      directionsOf(direction(1 - u.x * u.x, turn), direction(u.y * u.y, kTurn * u.z), l, v);
    } else {
      l = direction(u.x * u.x, turn);
      v = direction(u.y * u.y, turn + kTurn * u.z);
    }
    if (!(l.z > 1e-4 && v.z > 1e-4)) continue;
    const dvec3 f = brdf(l, v);
    if (!finite(f)) continue;
    positive = positive || f.x > 0 || f.y > 0 || f.z > 0;
    samples.push_back({l, v, glm::max(f, dvec3(0))});
  }
  if (samples.empty())
    throw Error("there is nothing to fit: the BRDF is not finite at any pair of directions");
  if (!positive) throw Error("there is nothing to fit: the BRDF is 0 or less at every pair of directions");
  return samples;
}

dvec3 diffuseFloor(const std::vector<BrdfSample>& samples) {
  dvec3 floor(0);
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const BrdfSample& sample : samples)
      if (sample.l.z > 0.3 && sample.v.z > 0.3) values.push_back(sample.f[c]);
    if (values.empty()) return dvec3(0);
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 50);
    std::nth_element(values.begin(), place, values.end());
    floor[c] = *place;
  }
  return floor;
}

}  // namespace limn::brdf
