#include "core/scene/instance_areas.h"

#include <algorithm>

namespace limn::scene {
namespace {

/// Areas may grow or shrink by this factor.
constexpr double kAreaChange = 1.5;
/// Of the largest area: what is smaller is none but for rounding, as across flat instances.
constexpr double kNoArea = 1e-5;

}  // namespace

glm::dvec3 areaFactors(const glm::mat4& matrix) {
  const glm::dmat3 m{glm::dmat4(matrix)};
  return {glm::length(glm::cross(m[1], m[2])), glm::length(glm::cross(m[2], m[0])),
          glm::length(glm::cross(m[0], m[1]))};
}

bool areasAlike(const glm::dvec3& a, const glm::dvec3& b) {
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::max({most, a[i], b[i]});
  for (int i = 0; i < 3; ++i) {
    const double low = std::max(std::min(a[i], b[i]), kNoArea * most);
    if (std::max(a[i], b[i]) > kAreaChange * low) return false;
  }
  return true;
}

}  // namespace limn::scene
