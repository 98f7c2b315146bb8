// Declares what the estimators of light in media share.
#pragma once

#include "glsl/light/light_view.glsl"
#include "glsl/light/rectangle_light.glsl"

namespace limn::reference {

/// Returns the point on a light that u in [0, 1)^2 selects.
inline glm::vec3 lightPoint(const glsl::Light& light, glm::vec2 u) {
  return glsl::rectangle_point(light, u - 0.5f);
}

/// Returns the unit direction that a directional light without sides shines along where u in [0, 1)^2 selects
/// it: even over the solid angle of its disc, as ConeView has it.
inline glm::vec3 discDirection(const glsl::Light& light, glm::vec2 u) {
  if (!(light.angular_diameter > 0)) return light.direction;
  const glsl::LightView view = glsl::light_view(light, glm::vec3(0), -light.direction, -1);
  return -glm::normalize(glsl::light_view_point(view, u));
}

}  // namespace limn::reference
