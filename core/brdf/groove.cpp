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
  sums_.assign(3 * (strips_ + 1) * (strips_ + 1), glm::dvec3(0));
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
    std::vector<double> transport;
    transport.reserve(count * count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        transport.push_back(root(i) * matrix.at(i, j) * root(j) * std::numbers::inv_pi);
    addSums(transport, channel);
  }
}

void GrooveBrdf::addSums(const std::vector<double>& transport, int channel) {
  for (std::size_t pair = 0; pair < 3; ++pair) {
    const std::size_t one = pair / 2, other = (pair + 1) / 2;  // walls
    // All terms are positive, so that nothing cancels.
    for (std::size_t i = strips_; i-- > 0;) {
      double row = 0;
      for (std::size_t j = strips_; j-- > 0;) {
        row += transport[(one * strips_ + i) * 2 * strips_ + other * strips_ + j];
        sums_[index(pair, i, j)][channel] = row + sums_[index(pair, i + 1, j)][channel];
      }
    }
    if (one != other) continue;
    for (std::size_t i = 0; i < strips_; ++i)  // to the bit, as f is to be reciprocal
      for (std::size_t j = 0; j < i; ++j)
        sums_[index(pair, i, j)][channel] = sums_[index(pair, j, i)][channel];
  }
}

GrooveBrdf::Walls GrooveBrdf::exposure(const glm::dvec3& d) const {
  Walls walls;
  if (!(d.z > 0)) return walls;
  const auto strips = static_cast<double>(strips_);
  for (std::size_t wall = 0; wall < 2; ++wall) {
    const double facing = wall == 0 ? -d.x : d.x;  // towards the opposite crest
    const double cosine = cosine_ * d.z + sine_ * facing;
    if (cosine <= 0) continue;
    // A point t of the way up sees d over the opposite crest where d.z / facing >= tan(slope) (1 - t) / (1 +
    // t).
    const double rise = tangent_ * std::max(facing, 0.0);
    const double hidden = strips * std::max((rise - d.z) / (rise + d.z), 0.0);
    const std::size_t strip = std::min(static_cast<std::size_t>(hidden), strips_ - 1);
    walls[wall] = {.amount = 0.5 * cosine / (strips * cosine_ * d.z),
                   .strip = strip,
                   .hidden = hidden - static_cast<double>(strip)};
  }
  return walls;
}

glm::dvec3 GrooveBrdf::reflected(const Walls& light, const Walls& view) const {
  glm::dvec3 sum(0);
  for (std::size_t lit = 0; lit < 2; ++lit)
    for (std::size_t seen = 0; seen < 2; ++seen) {
      const double amount = light[lit].amount * view[seen].amount;
      if (!(amount > 0)) continue;
      const bool turned = seen > lit;  // the pair has the rising wall first
      const Wall &one = turned ? light[lit] : view[seen], &other = turned ? view[seen] : light[lit];
      // Of the first strip only a part counts: between the sum with it and that without it.
      const glm::dvec3* whole = &sums_[index(lit + seen, one.strip, other.strip)];
      const glm::dvec3* without = whole + strips_ + 1;
      sum += amount * glm::mix(glm::mix(whole[0], whole[1], other.hidden),
                               glm::mix(without[0], without[1], other.hidden), one.hidden);
    }
  return sum;
}

glm::dvec3 GrooveBrdf::evaluate(const glm::dvec3& l, const glm::dvec3& v) const {
  return reflected(exposure(l), exposure(v));
}

AnisotropicTable GrooveBrdf::table(int size) const {
  AnisotropicTable table{.size = size, .values = {}};
  std::vector<Walls> exposures;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) exposures.push_back(exposure(glm::dvec3(table.texelDirection(x, y))));
  table.values.reserve(exposures.size() * exposures.size());
  for (const Walls& view : exposures)
    for (const Walls& light : exposures) table.values.emplace_back(reflected(light, view));
  return table;
}

}  // namespace limn::brdf
