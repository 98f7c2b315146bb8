#include "core/relief/horizon.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/relief/private/cell_walk.h"

namespace limn::relief {
namespace {

double largestSide(const HeightField& field) {
  const glm::dvec2 side = glm::dvec2(field.size()) * field.spacing();
  return std::max(side.x, side.y);
}

/// Returns the texels along the longer axis.
int largestSize(const HeightField& field) {
  return std::max(field.size().x, field.size().y);
}

/// Returns the largest (z(s) - level) / s over a cell, z = constant + linear s + square s^2 - level.
double steepestSight(double constant, double linear, double square, double enter, double leave) {
  const auto slope = [&](double s) { return constant / s + linear + square * s; };
  double most = enter > 0 ? slope(enter) : linear;
  if (std::isfinite(leave)) most = std::max(most, slope(leave));
  if (constant < 0 && square < 0) {
    const double top = std::sqrt(constant / square);
    if (top > enter && top < leave) most = std::max(most, slope(top));
  }
  return most;
}

/// Returns the horizon's tangent from what the line along `direction` (texels per metre) meets in cells that
/// begin up to `farthest` metres away.
double horizonWithin(const HeightField& field, const glm::dvec2& place, const glm::dvec2& direction,
                     double farthest) {
  const double level = field.height(place), rise = field.highest() - level;
  double most = 0;
  for (CellWalk walk(place, direction); walk.enter() <= farthest; walk.advance()) {
    if (rise <= most * walk.enter()) break;
    const Patch cell = field.patch(walk.cell());
    const glm::dvec2 origin = walk.inside(0);
    const double constant = walk.enter() > 0 ? cell.at(origin) - level : 0;
    const double linear =
        glm::dot(cell.slope, direction) + cell.twist * (origin.x * direction.y + origin.y * direction.x);
    const double square = cell.twist * direction.x * direction.y;
    most = std::max(most, steepestSight(constant, linear, square, walk.enter(), walk.leave()));
  }
  return most;
}

/// Sweeps along one azimuth. The axis along which the lines cover most texels is called major, the other one
/// minor; every line has a vertex at each texel of the major axis and one at each row of the minor axis that
/// it crosses.
class Sweep {
 public:
  Sweep(const HeightField& field, double azimuth) : field_(field) {
    direction_ = glm::dvec2(std::cos(azimuth), std::sin(azimuth)) / field.spacing();
    // Along a side of one texel nothing changes: of a line only its way along the other side counts.
    for (int axis = 0; axis < 2; ++axis)
      if (field.size()[axis] == 1 && direction_[1 - axis] != 0) direction_[axis] = 0;
    major_ = std::abs(direction_.x) >= std::abs(direction_.y) ? 0 : 1;
    const bool level = field.size()[major_] == 1;  // all along the line
    const int minor = 1 - major_;
    forward_ = direction_[major_] > 0 ? 1 : -1;
    tilt_ = direction_[minor] / std::abs(direction_[major_]);
    metres_ = 1 / std::abs(direction_[major_]);
    length_ = field.size()[major_];
    const double reach =
        level ? 0 : std::min(64 * (field.highest() - field.lowest()), 8 * largestSide(field));
    ahead_ = static_cast<int>(std::ceil(std::min(reach / metres_, 8.0 * largestSize(field)))) + 1;
    // Lines are numbered by where they meet the first texel of their way; periodic ones return after one
    // size.
    const double shift = tilt_ * (length_ - 1);
    firstLine_ = field.wrap() == Wrap::periodic ? 0 : static_cast<int>(std::floor(std::min(-shift, 0.0)));
    const int lastLine = field.size()[minor] + static_cast<int>(std::ceil(std::max(-shift, 0.0)));
    lines_ = field.wrap() == Wrap::periodic ? field.size()[minor] : lastLine - firstLine_ + 1;
  }

  /// Writes the tangents of all texels: the steeper one of what lies near, exactly, and of what the lines
  /// have passed.
  void write(float* tangents) {
    far_.assign(field_.texels(), 0.0);
    for (int line = 0; line < lines_; ++line) follow(firstLine_ + line);
    for (int y = 0; y < field_.size().y; ++y)
      for (int x = 0; x < field_.size().x; ++x) {
        const std::size_t texel = field_.index({x, y});
        tangents[texel] = static_cast<float>(
            std::max(far_[texel], horizonWithin(field_, {x, y}, direction_, kNear * metres_)));
      }
  }

 private:
  struct Vertex {
    double s, z;  // metres along the line; height

    double slopeTo(const Vertex& other) const { return (other.z - z) / (other.s - s); }
  };
  static constexpr int kNear =
      2;  // texels of the major axis; what lies nearer would move too far with the line

  /// Puts a vertex in front of those of the hull.
  void add(const Vertex& vertex) {
    while (hull_.size() > 1 && vertex.slopeTo(hull_.back()) <= vertex.slopeTo(hull_[hull_.size() - 2]))
      hull_.pop_back();
    hull_.push_back(vertex);
  }

  /// Returns the steepest slope from a point in front of the hull to it. Slopes rise up to the vertex that a
  /// tangent touches, and fall behind it.
  double slopeToHull(const Vertex& point) const {
    std::size_t low = 0, high = hull_.size() - 1;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (point.slopeTo(hull_[middle + 1]) >= point.slopeTo(hull_[middle]))
        low = middle + 1;
      else
        high = middle;
    }
    return point.slopeTo(hull_[low]);
  }

  double heightAt(int majorStep, double minorPlace) const {
    const double along = forward_ > 0 ? majorStep : length_ - 1 - majorStep;
    glm::dvec2 place;
    place[major_] = along;
    place[1 - major_] = minorPlace;
    return field_.height(place);
  }

  /// Adds to the texels on both sides of a line what it sees from each, by how near it passes.
  void follow(int line) {
    hull_.clear();
    for (int step = length_ - 1 + ahead_ + kNear; step >= kNear; --step) {
      const double minor = line + tilt_ * step;
      add({step * metres_, heightAt(step, minor)});
      if (step - kNear < length_) see(step - kNear, line + tilt_ * (step - kNear));
      // Between this vertex and the one before it on the way, at most one row is crossed.
      const double row = tilt_ > 0 ? std::ceil(minor) - 1 : std::floor(minor) + 1;
      const double share = tilt_ == 0 ? 1 : (minor - row) / tilt_;
      if (share > 1e-9 && share < 1 - 1e-9) add({(step - share) * metres_, crossing(step, share, row)});
    }
  }

  void see(int step, double minor) {
    const double below = std::floor(minor);
    for (int side = 0; side < 2; ++side) {
      glm::ivec2 texel;
      texel[major_] = forward_ > 0 ? step : length_ - 1 - step;
      texel[1 - major_] = static_cast<int>(below) + side;
      const bool inside = texel[1 - major_] >= 0 && texel[1 - major_] < field_.size()[1 - major_];
      if (!inside && field_.wrap() == Wrap::clamped) continue;
      const double weight = side == 0 ? 1 - (minor - below) : minor - below;
      const double slope = slopeToHull({step * metres_, field_.texel(texel)});
      far_[field_.index(texel)] += weight * std::max(slope, 0.0);
    }
  }

  double crossing(int step, double share, double row) const {
    return glm::mix(heightAt(step, row), heightAt(step - 1, row), share);
  }

  const HeightField& field_;
  int major_ = 0, forward_ = 1, length_ = 1, ahead_ = 0, firstLine_ = 0, lines_ = 1;
  glm::dvec2 direction_{0};  // texels per metre
  double tilt_ = 0;          // rows of the minor axis per texel of the major one
  double metres_ = 1;        // along the line per texel of the major axis
  std::vector<Vertex> hull_;
  std::vector<double> far_;
};

}  // namespace

double Horizons::angle(int azimuth) const {
  return 2 * std::numbers::pi * azimuth / azimuths;
}

double exactHorizon(const HeightField& field, const glm::dvec2& place, double azimuth) {
  const glm::dvec2 direction = glm::dvec2(std::cos(azimuth), std::sin(azimuth)) / field.spacing();
  return horizonWithin(field, place, direction, kFarthestSizes * largestSide(field));
}

Horizons sweepHorizons(const HeightField& field, int azimuths) {
  if (azimuths < 1) throw UsageError(fmt::format("{} azimuths of horizons: at least 1 is needed", azimuths));
  Horizons result{.azimuths = azimuths, .texels = field.texels(), .tangents = {}};
  result.tangents.resize(static_cast<std::size_t>(azimuths) * field.texels());
  tbb::parallel_for(0, azimuths, [&](int i) {
    Sweep(field, result.angle(i)).write(result.tangents.data() + static_cast<std::size_t>(i) * result.texels);
  });
  return result;
}

}  // namespace limn::relief
