// Declares what says whether vectors and matrices are numbers. Internal to core/scene.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace limn::scene {

inline bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Ignores the last row, which is 0, 0, 0, 1.
inline bool finite(const glm::mat4& m) {
  for (int c = 0; c < 4; ++c)
    if (!finite(glm::vec3(m[c]))) return false;
  return true;
}

}  // namespace limn::scene
