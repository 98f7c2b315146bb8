// Declares the cells of a directional tree while it is built, and the memory that they share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/radiosity/private/unit_cell.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::radiosity {

/// The lobes that are still evaluated: where in the arenas their numbers and their descriptions begin.
struct LobeSet {
  size_t list, rows;
  uint32_t count;
};

/// One cell while the tree is built. Points 0 to 2 are the corners, point 3 is the centre.
struct TreeCell {
  UnitCell shape;
  glm::vec3 totals[4];  ///< all lobes at the points
  glm::vec3 linear[3];  ///< of lobes that are no longer evaluated, at the corners
  float bent;           ///< by how much these are off at the centres of the cells that took them, luminance
  LobeSet lobes;        ///< the others
  size_t blocks[4];     ///< and where their values at the points begin
  uint32_t child;
  int level;
  float weight;
  double power, error;  ///< weight times squared luminance, and squared error by the criterion's measure

  glm::vec3 value() const { return 0.75f * totals[3] + (totals[0] + totals[1] + totals[2]) / 12.f; }
  /// The estimate of the squared error over the cell, of luminance.
  float variance() const {
    const float a = glsl::luminance(totals[0]), b = glsl::luminance(totals[1]),
                c = glsl::luminance(totals[2]);
    const float bend = glsl::luminance(totals[3]) - (a + b + c) / 3;
    return ((a - b) * (a - b) + (b - c) * (b - c) + (c - a) * (c - a)) / 36 + 0.25f * bend * bend;
  }
  /// Whether the published test asks for more; `beside`: luminance beside the cell's.
  bool varies(float most, float beside) const {
    float low = glsl::luminance(totals[3]), high = low;
    for (int i = 0; i < 3; ++i) {
      low = std::min(low, glsl::luminance(totals[i]));
      high = std::max(high, glsl::luminance(totals[i]));
    }
    return high - low > most * (glsl::luminance(totals[3]) + beside);
  }
  /// The longest edge, rad.
  float edge() const {
    float least = 1;
    for (int i = 0; i < 3; ++i)
      least = std::min(least, glm::dot(shape.corners[i], shape.corners[(i + 1) % 3]));
    return std::acos(std::max(least, -1.f));
  }
};

/// Memory from which pieces are taken and which is given back all at once.
template <class T>
class Arena {
 public:
  void reset() { used_ = 0; }
  size_t take(size_t count) {
    const size_t first = used_;
    used_ += count;
    if (used_ > values_.size()) values_.resize(2 * used_);
    return first;
  }
  /// Returns what was taken, bytes.
  size_t memory() const { return used_ * sizeof(T); }
  T* at(size_t first) { return values_.data() + first; }

 private:
  std::vector<T> values_;
  size_t used_ = 0;
};

/// A cell that may be split, or a lobe whose peak may be sought.
struct Candidate {
  double priority;
  uint32_t index;
  bool operator<(const Candidate& other) const {
    return priority != other.priority ? priority < other.priority : index > other.index;
  }
};

}  // namespace limn::radiosity
