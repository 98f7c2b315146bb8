#include "core/reference/private/light_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::reference {
namespace {

/// Distance along the light's normal that clears its own surface, as Draw::rayOffset does for receivers.
float lightOffset(const glsl::Light& light) {
  const glm::vec3 reach = glm::abs(light.position) + glm::abs(light.axis_u) * light.length_u +
                          glm::abs(light.axis_v) * light.length_v;
  return 0x1p-20f * std::max(reach.x, std::max(reach.y, reach.z));
}

}  // namespace

AskedLights askedLights(const Request& request) {
  const int count = static_cast<int>(request.pose.lights.size());
  if (request.light == kAllLights) return {0, ownLights(request.pose), true};
  return {std::min(request.light, count), std::min(request.light + 1, count), request.light == count};
}

bool isPunctual(const glsl::Light& light) {
  return light.type == glsl::light_point || light.type == glsl::light_spot ||
         (light.type == glsl::light_directional && !(light.angular_diameter > 0.f) &&
          !glsl::light_is_distant_rectangle(light));
}

bool unblocked(const RayScene& rays, const Surface& receiver, const Arrival& arrival) {
  const glm::vec3 origin = receiver.rayOrigin(arrival.direction);
  if (arrival.finite) return !rays.shadowed(origin, arrival.target - origin, arrival.end);
  return !rays.shadowed(origin, arrival.direction, std::numeric_limits<float>::infinity());
}

PointView::PointView(const glsl::Light& light, const Surface& receiver) {
  if (light.type == glsl::light_directional) {
    arrival_.direction = -light.direction;
  } else {
    const glm::vec3 offset = light.position - receiver.position;
    const float distance = glm::length(offset);
    if (!(distance > 0.f)) return;
    arrival_.direction = offset / distance;
    arrival_.target = light.position;
    // A lamp may be mounted on a surface, which rounding puts on either side of it: the more so, the flatter
    // the light falls in.
    const float clearance = 16 * std::max(lightOffset(light), 0x1p-20f * distance);
    arrival_.end = 1 - std::min(clearance / distance, 0.5f);
    arrival_.finite = true;
  }
  above_ = glm::dot(arrival_.direction, receiver.values.geometric_normal) > 0.f &&
           glsl::receiver_factor(light, receiver.position) > 0.f;
  irradiance_ = glsl::punctual_irradiance(light, receiver.position);
}

RectangleView::RectangleView(const glsl::Light& light, const Surface& receiver)
    : light_(light), receiver_(receiver.position), normal_(receiver.values.geometric_normal) {
  if (glsl::light_is_instance(light, receiver.draw)) return;
  part_ = glsl::rectangle_visible_part(light, receiver_, normal_);
  if (part_.count == 0) return;
  rectangle_ = glsl::rectangle_from(light, receiver_);
  area_ = glsl::rectangle_part_share(part_) * light.length_u * light.length_v;
  radiance_ = glsl::rectangle_radiance(light) * glsl::receiver_factor(light, receiver_);
  facing_ = light.direction;
  if (glsl::light_is_distant_rectangle(light)) {
    facing_ = glm::cross(light.axis_v, light.axis_u);
    return;
  }
  finite_ = true;
  clearance_ = lightOffset(light) * glsl::rectangle_side(light, receiver_) * light.direction;
}

Arrival RectangleView::at(glm::vec2 ab) const {
  Arrival arrival;
  const glm::vec3 offset = glsl::rectangle_point(rectangle_, ab);
  const float distance2 = glm::dot(offset, offset);
  if (!(distance2 > 0.f)) return arrival;
  arrival.direction = offset / std::sqrt(distance2);
  if (finite_) arrival.target = receiver_ + offset + clearance_;
  arrival.finite = finite_;
  const float projected = std::abs(glm::dot(facing_, arrival.direction)) * area_;
  if (!(projected > 0.f)) return arrival;
  arrival.pdf = distance2 / projected;
  arrival.radiance = radiance_;
  arrival.irradianceWeight = std::max(glm::dot(normal_, arrival.direction), 0.f) / arrival.pdf;
  return arrival;
}

Arrival RectangleView::sample(glm::vec2 u) const {
  return at(glsl::rectangle_part_sample(part_, u));
}

Arrival RectangleView::towards(const glm::vec3& direction) const {
  const float distance = glm::dot(facing_, rectangle_.centre) / glm::dot(facing_, direction);
  if (!(distance > 0.f && std::isfinite(distance))) return {};
  const glm::vec3 offset = distance * direction - rectangle_.centre;
  const glm::vec2 ab(glm::dot(offset, light_.axis_u) / light_.length_u,
                     glm::dot(offset, light_.axis_v) / light_.length_v);
  return std::abs(ab.x) <= 0.5f && std::abs(ab.y) <= 0.5f ? at(ab) : Arrival{};
}

ConeView::ConeView(const glsl::Light& light, const Surface& receiver)
    : normal_(receiver.values.geometric_normal) {
  const float half = std::min(0.5f * light.angular_diameter, 1.55f);
  const float sine = std::sin(half), sineHalf = std::sin(0.5f * half);
  frame_ = glsl::frame_around(-light.direction);
  oneMinusCosine_ = 2.f * sineHalf * sineHalf;
  radiance_ = light.emission / (glsl::pi * sine * sine);
  above_ = glm::dot(frame_.n, normal_) > -sine;
}

Arrival ConeView::along(const glm::vec3& direction) const {
  Arrival arrival;
  arrival.direction = direction;
  arrival.pdf = 1.f / (2.f * glsl::pi * oneMinusCosine_);
  arrival.radiance = radiance_;
  arrival.irradianceWeight = std::max(glm::dot(normal_, direction), 0.f);
  return arrival;
}

Arrival ConeView::sample(glm::vec2 u) const {
  const glm::vec2 disc = glsl::sample_disc(u);
  const float radius2 = std::min(glm::dot(disc, disc), 1.f);
  // 1 - cos is uniform; the sine is sqrt((1 - cos)(1 + cos)).
  const float cap = radius2 * oneMinusCosine_;
  const float lateral = std::sqrt(oneMinusCosine_ * (2.f - cap));
  return along(glm::normalize(glsl::from_local(frame_, glm::vec3(lateral * disc, 1.f - cap))));
}

Arrival ConeView::towards(const glm::vec3& direction) const {
  const glm::vec3 away = direction - frame_.n;  // |away|^2 / 2 = 1 - cos
  return 0.5f * glm::dot(away, away) <= oneMinusCosine_ ? along(direction) : Arrival{};
}

Arrival EnvironmentView::towards(const glm::vec3& direction) const {
  Arrival arrival;
  arrival.direction = direction;
  const scene::EnvironmentLight::Sight seen = environment_.at(direction);
  arrival.pdf = seen.pdf;
  arrival.radiance = seen.radiance;
  return arrival;
}

}  // namespace limn::reference
