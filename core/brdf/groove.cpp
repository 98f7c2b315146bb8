#include "core/brdf/groove.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limn::brdf {
namespace {

/// A dense symmetric positive definite matrix.
class GramMatrix {
 public:
  explicit GramMatrix(std::size_t size) : size_(size), values_(size * size) {}
  double& at(std::size_t row, std::size_t column) { return values_[row * size_ + column]; }

  /// Replaces the matrix by its inverse, by Cholesky's factors M = L L^T.
  void invert() {
    for (std::size_t j = 0; j < size_; ++j)
      for (std::size_t i = j; i < size_; ++i) {
        double sum = at(i, j);
        for (std::size_t k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
        at(i, j) = i == j ? std::sqrt(sum) : sum / at(j, j);
      }
    // L^-1 below the diagonal in place, then L^-T L^-1.
    for (std::size_t j = 0; j < size_; ++j) {
      at(j, j) = 1 / at(j, j);
      for (std::size_t i = j + 1; i < size_; ++i) {
        double sum = 0;
        for (std::size_t k = j; k < i; ++k) sum -= at(i, k) * at(k, j);
        at(i, j) = sum / at(i, i);
      }
    }
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0;
        for (std::size_t k = i; k < size_; ++k) sum += at(k, i) * at(k, j);
        at(i, j) = sum;
      }
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = 0; j < i; ++j) at(j, i) = at(i, j);
  }

 private:
  std::size_t size_;
  std::vector<double> values_;
};

}  // namespace

GrooveBrdf::GrooveBrdf(const Groove& groove)
    : tangent_(std::tan(static_cast<double>(groove.slope))),
      cosine_(std::cos(static_cast<double>(groove.slope))),
      sine_(std::sin(static_cast<double>(groove.slope))),
      strips_(static_cast<std::size_t>(std::max(groove.strips, 1))) {
  const std::size_t count = 2 * strips_;
  const double width = 1 / static_cast<double>(strips_), length = 0.5 * width / cosine_;
  // The end of a strip, t of the way from the bottom at the origin to the crest.
  const auto end = [&](double side, std::size_t strip) {
    return glm::dvec2(side, tangent_) * (0.5 * width * static_cast<double>(strip));
  };
  transport_.assign(count * count, glm::dvec3(0));
  for (int channel = 0; channel < 3; ++channel) {
    const double rising = std::sqrt(static_cast<double>(groove.rising[channel]));
    const double falling = std::sqrt(static_cast<double>(groove.falling[channel]));
    // Radiosity B = R (E + K B), with K_ij = F_ij, so that B = r (A - r A K r)^-1 r (A E), where A holds the
    // lengths and r = sqrt(R): A K is symmetric, and by the rule of crossed strings it is exact (Hottel
    // 1954).
    GramMatrix matrix(count);
    for (std::size_t i = 0; i < count; ++i) matrix.at(i, i) = length;
    for (std::size_t i = 0; i < strips_; ++i)
      for (std::size_t j = 0; j < strips_; ++j) {
        const glm::dvec2 p0 = end(1, i), p1 = end(1, i + 1), q0 = end(-1, j), q1 = end(-1, j + 1);
        const double exchange = 0.5 * (glm::distance(p0, q1) + glm::distance(p1, q0) - glm::distance(p0, q0) -
                                       glm::distance(p1, q1));
        matrix.at(i, strips_ + j) = matrix.at(strips_ + j, i) = -rising * falling * exchange;
      }
    matrix.invert();
    const auto root = [&](std::size_t strip) { return strip < strips_ ? rising : falling; };
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        transport_[i * count + j][channel] = root(i) * matrix.at(i, j) * root(j) * std::numbers::inv_pi;
  }
}

std::vector<double> GrooveBrdf::exposure(const glm::dvec3& d) const {
  std::vector<double> shares(2 * strips_, 0.0);
  if (!(d.z > 0)) return shares;
  const double width = 1 / static_cast<double>(strips_);
  for (std::size_t wall = 0; wall < 2; ++wall) {
    const double facing = wall == 0 ? -d.x : d.x;  // towards the opposite crest
    const double cosine = cosine_ * d.z + sine_ * facing;
    if (cosine <= 0) continue;
    // A point t of the way up sees d over the opposite crest where d.z / facing >= tan(slope) (1 - t) / (1 +
    // t).
    const double rise = tangent_ * std::max(facing, 0.0);
    const double lowest = std::max((rise - d.z) / (rise + d.z), 0.0);
    for (std::size_t i = 0; i < strips_; ++i) {
      const double below = static_cast<double>(i) * width;
      const double seen = std::clamp((below + width - lowest) / width, 0.0, 1.0);
      shares[wall * strips_ + i] = 0.5 * width / cosine_ * seen * cosine / d.z;
    }
  }
  return shares;
}

std::vector<glm::dvec3> GrooveBrdf::radiosity(const std::vector<double>& light) const {
  std::vector<glm::dvec3> radiances(light.size(), glm::dvec3(0));
  for (std::size_t i = 0; i < light.size(); ++i)
    for (std::size_t j = 0; j < light.size(); ++j)
      radiances[i] += transport_[i * light.size() + j] * light[j];
  return radiances;
}

glm::dvec3 GrooveBrdf::evaluate(const glm::dvec3& l, const glm::dvec3& v) const {
  const std::vector<glm::dvec3> radiances = radiosity(exposure(l));
  const std::vector<double> seen = exposure(v);
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < seen.size(); ++i) sum += seen[i] * radiances[i];
  return sum;
}

AnisotropicTable GrooveBrdf::table(int size) const {
  AnisotropicTable table{.size = size, .values = {}};
  std::vector<std::vector<double>> exposures;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) exposures.push_back(exposure(glm::dvec3(table.texelDirection(x, y))));
  const std::size_t texels = exposures.size();
  table.values.resize(texels * texels);
  for (std::size_t l = 0; l < texels; ++l) {
    const std::vector<glm::dvec3> radiances = radiosity(exposures[l]);
    for (std::size_t v = 0; v < texels; ++v) {
      glm::dvec3 sum(0);
      for (std::size_t i = 0; i < radiances.size(); ++i) sum += exposures[v][i] * radiances[i];
      table.values[v * texels + l] = glm::vec3(sum);
    }
  }
  return table;
}

}  // namespace limn::brdf
