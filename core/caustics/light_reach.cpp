#include "core/caustics/private/light_reach.h"

#include <algorithm>
#include <cmath>

namespace limn::caustics {
namespace {

/// Room for rounding, a part of all lengths that are compared; of angles, radians.
constexpr double kRoom = 1e-4;

double angleOf(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

bool mayReachBox(const glsl::Light& light, const scene::Bounds& box) {
  if (light.type == glsl::light_directional) return true;
  const glm::dvec3 origin(light.position), towards = glm::dvec3(box.centre()) - origin;
  const double distance = glm::length(towards), radius = double{box.radius()};
  const double reach = radius + kRoom * (radius + distance + glm::length(origin));
  if (distance <= reach) return true;
  if (light.range > 0 && distance - reach > double{light.range}) return false;
  const double along = glm::dot(glm::dvec3(light.direction), towards);
  const bool oneSided =
      light.type == glsl::light_rectangle && (light.flags & glsl::light_flag_two_sided) == 0;
  if (oneSided && along < -reach) return false;
  if ((light.flags & glsl::light_flag_cone) == 0) return true;
  return angleOf(along / distance) - std::asin(reach / distance) <= angleOf(double{light.cos_outer}) + kRoom;
}

}  // namespace

bool mayReach(const glsl::Light& light, std::span<const scene::Bounds> boxes) {
  return std::ranges::any_of(boxes, [&](const scene::Bounds& box) { return mayReachBox(light, box); });
}

}  // namespace limn::caustics
