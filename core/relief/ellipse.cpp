#include "core/relief/ellipse.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "core/base/error.h"

namespace limn::relief {
namespace {

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

/// Holds an ellipse's centre (x, y) and covariance (xx, xy, yy).
using Numbers = std::array<double, 5>;

/// Measures where ellipses differ from a region that is star-shaped about 0.
class Region {
 public:
  explicit Region(std::span<const double> rho) : rho_(rho) {
    const double step = 2 * std::numbers::pi / static_cast<double>(rho.size());
    for (std::size_t i = 0; i < rho.size(); ++i)
      directions_.emplace_back(std::cos(step * static_cast<double>(i)),
                               std::sin(step * static_cast<double>(i)));
  }

  /// Returns the differing part of the disc. Along each azimuth the region is [0, rho], and the ellipse what
  /// lies between the roots of a quadratic.
  double differs(const Numbers& ellipse) const {
    const auto& [x, y, xx, xy, yy] = ellipse;
    const double scale = 4 * (xx * yy - xy * xy);
    if (!(scale > 0) || !(xx > 0)) return 1;
    // The form of the ellipse, 1 on its edge: v^T form v.
    const glm::dmat2 form(yy / scale, -xy / scale, -xy / scale, xx / scale);
    const glm::dvec2 centre(x, y), towards = form * centre;
    const double atZero = glm::dot(centre, towards) - 1;
    double sum = 0;
    for (std::size_t i = 0; i < rho_.size(); ++i) {
      const glm::dvec2& direction = directions_[i];
      const double square = glm::dot(direction, form * direction), half = glm::dot(direction, towards);
      const double root = std::sqrt(std::max(half * half - square * atZero, 0.0));
      const double far = std::clamp((half + root) / square, 0.0, 1.0),
                   near = std::clamp((half - root) / square, 0.0, far);
      const double rho = rho_[i], shared = std::max(std::min(rho, far), near);
      sum += rho * rho + far * far + near * near - 2 * shared * shared;
    }
    return sum / static_cast<double>(rho_.size());
  }

 private:
  std::span<const double> rho_;
  std::vector<glm::dvec2> directions_;
};

Numbers numbersOf(const glsl::ReliefEllipse& ellipse) {
  return {static_cast<double>(ellipse.centre.x), static_cast<double>(ellipse.centre.y),
          static_cast<double>(ellipse.xx), static_cast<double>(ellipse.xy), static_cast<double>(ellipse.yy)};
}

/// Returns the radii of a texel's region.
void readRadii(const Horizons& horizons, std::size_t texel, std::vector<double>& rho) {
  rho.resize(static_cast<std::size_t>(horizons.azimuths));
  for (int i = 0; i < horizons.azimuths; ++i)
    rho[static_cast<std::size_t>(i)] = litRadius(static_cast<double>(horizons.tangent(i, texel)));
}

/// Returns what `ellipse` makes of the radii of each texel's region.
template <class Ellipse>
std::vector<glsl::ReliefEllipse> ofTexels(const Horizons& horizons, Ellipse&& ellipse) {
  std::vector<glsl::ReliefEllipse> result(horizons.texels);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, horizons.texels), [&](const auto& range) {
    std::vector<double> rho;
    for (std::size_t texel = range.begin(); texel < range.end(); ++texel) {
      readRadii(horizons, texel, rho);
      result[texel] = ellipse(rho);
    }
  });
  return result;
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
  const double step = 2 * std::numbers::pi / static_cast<double>(rho.size());
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
  return ofTexels(horizons, [](std::span<const double> rho) { return momentEllipse(rho); });
}

double differingArea(const glsl::ReliefEllipse& ellipse, std::span<const double> rho) {
  return Region(rho).differs(numbersOf(ellipse));
}

glsl::ReliefEllipse nearestEllipse(std::span<const double> rho, const glsl::ReliefEllipse& start) {
  const Region region(rho);
  Numbers best = numbersOf(start);
  const double determinant = best[2] * best[4] - best[3] * best[3];
  if (!(determinant > 0)) return start;
  // Half of a circle's radius of the same area, and that squared: what centres and covariances are compared
  // with.
  const double variance = std::sqrt(determinant), unit = std::sqrt(variance);
  double least = region.differs(best);
  for (double step = 0.128; step > 0.007;) {
    bool better = false;
    for (std::size_t i = 0; i < best.size(); ++i)
      for (const double way : {-step, step}) {
        Numbers next = best;
        next[i] += way * (i < 2 ? unit : variance);
        const double differs = region.differs(next);
        if (differs >= least) continue;
        least = differs;
        best = next;
        better = true;
      }
    if (!better) step /= 2;
  }
  return ellipseOf({best[0], best[1]}, {best[2], best[3], best[4]}, 0);
}

std::vector<glsl::ReliefEllipse> nearestEllipses(const Horizons& horizons) {
  return ofTexels(horizons,
                  [](std::span<const double> rho) { return nearestEllipse(rho, momentEllipse(rho)); });
}

void EllipseMean::add(const glsl::ReliefEllipse& ellipse) {
  const glm::dvec2 centre = ellipse.centre;
  const double product = static_cast<double>(glsl::ellipse_ambient(ellipse)),
               area = std::numbers::pi * product;
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
