#include "core/reference/private/airlight.h"

#include <limits>

#include "core/scene/light_texture.h"
#include "glsl/media/airlight.glsl"

namespace limn::reference {
namespace {

/// Random numbers of airlight lie behind those of all other estimators of a pixel.
constexpr uint32_t kFirstPair = 1u << 20;

}  // namespace

Airlight::Airlight(const RayScene& rays, const Request& request)
    : rays_(rays), lights_(mediumLights(request)) {}

glm::dvec3 Airlight::sample(const glm::vec3& eye, const glm::vec3& direction, float end,
                            const Sampler& sampler) const {
  const RayMedium& medium = rays_.medium();
  const glm::vec2 range = medium.range(eye, direction);
  const float from = std::max(range.x, 0.f), to = std::min(range.y, end);
  glm::dvec3 sum(0);
  if (!(from < to)) return sum;
  for (uint32_t i = 0; i < lights_.size(); ++i) {
    const glsl::Light& light = lights_[i];
    const glm::vec3 source = lightPoint(light, sampler.pair(kFirstPair + 2 * i));
    const glsl::AirlightRay ray = glsl::airlight_ray(medium.medium(), light, source, 0, eye, direction);
    const float low = glsl::airlight_variable(ray, from), high = glsl::airlight_variable(ray, to);
    const float t = glsl::airlight_metres(ray, low + sampler.pair(kFirstPair + 2 * i + 1).x * (high - low));
    const glsl::AirlightPoint point = glsl::airlight_point(light, ray, t, 1);
    const glm::vec3& x = point.place;
    const glm::vec3 tint = scene::lightTextureAt(rays_.scene(), light, x);
    const float density = medium.density(x);
    if (density == 0.f || point.sent == glm::vec3(0)) continue;
    const bool blocked = ray.parallel
                             ? rays_.shadowed(x, -light.direction, std::numeric_limits<float>::infinity())
                             : rays_.shadowed(x, source - x, 0.9999f);
    if (blocked) continue;
    const float toLight = ray.parallel ? medium.length(x, -point.from, std::numeric_limits<float>::max())
                                       : medium.lengthBetween(source, x);
    const glm::vec3 arriving =
        glsl::airlight_scattered(medium.medium(), ray, point, toLight + medium.length(eye, direction, t));
    sum += glm::dvec3(density * tint * arriving) * static_cast<double>(high - low);
  }
  return sum;
}

}  // namespace limn::reference
