#include "core/relief/ellipse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/base/error.h"

namespace limn::relief {
namespace {

constexpr double kPi = std::numbers::pi;

glsl::ReliefEllipse ellipseOf(const glm::dvec2& centre, const glm::dvec3& covariance, double spread) {
  return {.centre = centre,
          .xx = static_cast<float>(covariance.x),
          .xy = static_cast<float>(covariance.y),
          .yy = static_cast<float>(covariance.z),
          .spread = static_cast<float>(spread)};
}

/// Returns (xx, xy, yy) of the dyad v v^T.
glm::dvec3 dyad(const glm::dvec2& v) {
  return {v.x * v.x, v.x * v.y, v.y * v.y};
}

/// Returns the deviation of values with the given mean and mean square.
double deviation(double mean, double meanSquare) {
  return std::sqrt(std::max(meanSquare - mean * mean, 0.0));
}

/// Returns the unit vector along the larger axis of a covariance, and both eigenvalues, the larger one first.
struct Axes {
  glm::dvec2 axis, eigenvalues;
};
Axes axesOf(const glm::dvec3& s) {
  const double middle = (s.x + s.z) / 2, half = (s.x - s.z) / 2, apart = std::hypot(half, s.y);
  const double angle = std::atan2(s.y, half) / 2;
  return {.axis = {std::cos(angle), std::sin(angle)},
          .eigenvalues = {middle + apart, std::max(middle - apart, 0.0)}};
}

/// Returns lit minus shadowed directions inside.
int score(const glsl::FittedEllipse& ellipse, std::span<const glm::vec2> directions,
          std::span<const std::uint8_t> lit) {
  int sum = 0;
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (glsl::fitted_lit(ellipse, glm::vec3(directions[i], 1))) sum += lit[i] ? 1 : -1;
  return sum;
}

}  // namespace

glsl::ReliefEllipse momentEllipse(std::span<const double> rho) {
  if (rho.size() < 3)
    throw UsageError(fmt::format("moments of {} azimuths: at least 3 are needed", rho.size()));
  const double step = 2 * kPi / static_cast<double>(rho.size());
  double area = 0;
  glm::dvec2 first(0);
  glm::dvec3 second(0);
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double angle = step * static_cast<double>(i), r = rho[i];
    const glm::dvec2 direction(std::cos(angle), std::sin(angle));
    area += step / 2 * r * r;
    first += step / 3 * r * r * r * direction;
    second += step / 4 * r * r * r * r * dyad(direction);
  }
  if (!(area > 0)) return ellipseOf(glm::dvec2(0), glm::dvec3(0), 0);
  const glm::dvec2 centre = first / area;
  return ellipseOf(centre, second / area - dyad(centre), 0);
}

std::vector<glsl::ReliefEllipse> momentEllipses(const Horizons& horizons) {
  std::vector<glsl::ReliefEllipse> result;
  result.reserve(horizons.texels);
  std::vector<double> rho(static_cast<std::size_t>(horizons.azimuths));
  for (std::size_t texel = 0; texel < horizons.texels; ++texel) {
    for (int i = 0; i < horizons.azimuths; ++i)
      rho[static_cast<std::size_t>(i)] = litRadius(static_cast<double>(horizons.tangent(i, texel)));
    result.push_back(momentEllipse(rho));
  }
  return result;
}

void EllipseMean::add(const glsl::ReliefEllipse& ellipse) {
  const glm::dvec2 centre = ellipse.centre;
  const double product = static_cast<double>(glsl::ellipse_ambient(ellipse)), area = kPi * product;
  count_ += 1;
  area_ += area;
  size_ += std::sqrt(product);
  squaredSize_ += product;
  centre_ += centre;
  squaredCentre_ += glm::dot(centre, centre);
  areaCentre_ += area * centre;
  second_ += area * (glm::dvec3(ellipse.xx, ellipse.xy, ellipse.yy) + dyad(centre));
}

glsl::ReliefEllipse EllipseMean::mean() const {
  if (!(area_ > 0)) return ellipseOf(glm::dvec2(0), glm::dvec3(0), 0);
  const glm::dvec2 centre = areaCentre_ / area_;
  const double ofCentres =
      deviation(glm::length(centre_) / count_, squaredCentre_ / count_) / std::numbers::sqrt2;
  const double ofSizes = deviation(size_ / count_, squaredSize_ / count_);
  return ellipseOf(centre, second_ / area_ - dyad(centre), ofCentres + ofSizes);
}

glsl::FittedEllipse fitPublished(std::span<const glm::vec2> directions, std::span<const std::uint8_t> lit) {
  if (directions.size() != lit.size())
    throw UsageError(fmt::format("{} directions and {} visibilities: one for each is needed",
                                 directions.size(), lit.size()));
  double count = 0;
  glm::dvec2 first(0);
  glm::dvec3 second(0);
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (lit[i]) {
      count += 1;
      first += glm::dvec2(directions[i]);
      second += dyad(directions[i]);
    }
  if (count == 0) return {.centre = glm::vec2(0), .axis = {1, 0}, .radii = glm::vec2(0)};
  const glm::dvec2 centre = first / count;
  const Axes axes = axesOf(second / count - dyad(centre));
  glsl::FittedEllipse best{.centre = centre, .axis = axes.axis, .radii = 2.0 * glm::sqrt(axes.eigenvalues)};
  int most = score(best, directions, lit);
  for (float step = 0.16f; step > 0.008f;) {
    bool better = false;
    for (const glm::vec2& move :
         {glm::vec2(step, 0), glm::vec2(-step, 0), glm::vec2(0, step), glm::vec2(0, -step)}) {
      glsl::FittedEllipse next = best;
      next.radii *= 1.0f + move;
      const int sum = score(next, directions, lit);
      if (sum <= most) continue;
      most = sum;
      best = next;
      better = true;
    }
    if (!better) step /= 2;
  }
  return best;
}

std::vector<glm::vec2> randomDisc(int count, std::uint32_t seed) {
  std::mt19937 engine(seed);
  const auto uniform = [&] { return (static_cast<float>(engine() >> 8) + 0.5f) / 16777216.0f; };
  std::vector<glm::vec2> result;
  while (std::ssize(result) < count) {
    const float x = 2 * uniform() - 1, y = 2 * uniform() - 1;
    if (x * x + y * y < 1) result.emplace_back(x, y);
  }
  return result;
}

}  // namespace limn::relief
