// Declares what the estimators of light in media share.
#pragma once

#include <vector>

#include "core/reference/reference.h"

namespace limn::reference {

/// Returns the lights that shine into the medium and through specular objects: the request's, without those
/// that stand for the environment.
inline std::vector<glsl::Light> mediumLights(const Request& request) {
  const int own = ownLights(request.pose);
  std::vector<glsl::Light> lights;
  for (int i = 0; i < own; ++i)
    if (request.light == kAllLights || request.light == i)
      lights.push_back(request.pose.lights[static_cast<size_t>(i)]);
  return lights;
}

/// Returns the point on a light that u in [0, 1)^2 selects.
inline glm::vec3 lightPoint(const glsl::Light& light, glm::vec2 u) {
  return light.position + (u.x - 0.5f) * light.length_u * light.axis_u +
         (u.y - 0.5f) * light.length_v * light.axis_v;
}

}  // namespace limn::reference
