#include "core/reference/private/airlight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/reference/private/light_view.h"
#include "core/reference/private/medium_view.h"
#include "core/scene/light_texture.h"
#include "glsl/media/airlight.glsl"
#include "glsl/numeric/geometry.glsl"

namespace limn::reference {
namespace {

/// Random numbers of airlight lie behind those of all other estimators of a pixel.
constexpr uint32_t kFirstLightPair = 1u << 20;

/// A light from far away as parallel light from one direction of it: even over the area of a distant
/// rectangle, or over the solid angle of a disc. Other lights as they are.
glsl::Light fromPointOf(const glsl::Light& light, glm::vec2 u) {
  if (light.type != glsl::light_directional) return light;
  glsl::Light part = light;
  if (!glsl::light_is_distant_rectangle(light)) {
    part.direction = discDirection(light, u);
    return part;
  }
  const glm::vec3 point = lightPoint(light, u);
  const float distance = glm::length(point);
  const float across = std::abs(glm::dot(glm::cross(light.axis_v, light.axis_u), point));
  const float solidAngle = light.length_u * light.length_v * across / (distance * distance * distance);
  part.direction = -point / distance;
  part.emission *= solidAngle / light.solid_angle;
  return part;
}

/// A direction about `axis` (unit) with Henyey and Greenstein's density of its cosine (1941, inverted).
glm::vec3 scatteredAbout(const glm::vec3& axis, float g, glm::vec2 u) {
  const double mean = g;
  double cosine = 1 - 2 * double{u.x};
  if (std::abs(mean) > 1e-3) {
    const double s = (1 - mean * mean) / (1 + mean - 2 * mean * double{u.x});
    cosine = std::clamp((1 + mean * mean - s * s) / (2 * mean), -1.0, 1.0);
  }
  const double sine = std::sqrt(1 - cosine * cosine), angle = 2 * double{glsl::pi} * double{u.y};
  return glm::normalize(glsl::from_local(glsl::frame_around(axis),
                                         glm::vec3(sine * std::cos(angle), sine * std::sin(angle), cosine)));
}

/// A distance, and over its density.
struct Distance {
  float metres;
  double measure;
};

/// Between two distances with a density that falls as exp(-rate metres).
Distance distanceBetween(float from, float to, float rate, float u) {
  const double reach = double{to} - double{from}, thickness = double{rate} * reach;
  if (!(thickness > 1e-4)) return {from + u * (to - from), reach};
  const double share = -std::expm1(-thickness), away = -std::log1p(-double{u} * share) / double{rate};
  return {std::min(static_cast<float>(double{from} + away), to),
          share / (double{rate} * std::exp(-double{rate} * away))};
}

}  // namespace

Airlight::Airlight(const RayScene& rays, const Request& request) : rays_(rays) {
  if (rays.medium().medium().scattering == glm::vec3(0)) return;
  const AskedLights asked = askedLights(request);
  const auto begin = request.pose.lights.begin();
  lights_.assign(begin + asked.first, begin + asked.last);
  if (asked.environment && rays.environment().present()) environment_ = &rays.environment();
}

glm::dvec3 Airlight::sample(const glm::vec3& eye, const glm::vec3& direction, float end,
                            const Sampler& sampler) const {
  const glm::vec2 range = rays_.medium().range(eye, direction);
  const Piece piece{eye, direction, std::max(range.x, 0.f), std::min(range.y, end)};
  glm::dvec3 sum(0);
  if (!(piece.from < piece.to)) return sum;
  uint32_t pair = kFirstLightPair;
  for (const glsl::Light& light : lights_) {
    sum += ofLight(piece, light, sampler, pair);
    pair += 2;
  }
  if (environment_) sum += ofEnvironment(piece, sampler, pair);
  return sum;
}

/// Distances are sampled evenly in the angle from the light (Kulla and Fajardo 2012).
glm::dvec3 Airlight::ofLight(const Piece& piece, const glsl::Light& whole, const Sampler& sampler,
                             uint32_t pair) const {
  const RayMedium& medium = rays_.medium();
  const glm::vec2 onLight = sampler.pair(pair);
  const glsl::Light light = fromPointOf(whole, onLight);
  const glm::vec3 source = lightPoint(light, onLight);
  const glsl::AirlightRay ray =
      glsl::airlight_ray(medium.medium(), light, source, 0, piece.eye, piece.direction);
  const float low = glsl::airlight_variable(ray, piece.from), high = glsl::airlight_variable(ray, piece.to);
  const float t = glsl::airlight_metres(ray, low + sampler.pair(pair + 1).x * (high - low));
  const glsl::AirlightPoint point = glsl::airlight_point(light, ray, t, 1);
  const glm::vec3& x = point.place;
  const glm::vec3 tint = scene::lightTextureAt(rays_.scene(), light, x);
  const float density = medium.density(x);
  if (density == 0.f || point.sent == glm::vec3(0)) return glm::dvec3(0);
  const bool blocked = ray.parallel
                           ? rays_.shadowed(x, -light.direction, std::numeric_limits<float>::infinity())
                           : rays_.shadowed(x, source - x, 0.9999f);
  if (blocked) return glm::dvec3(0);
  const float toLight = ray.parallel ? medium.length(x, -point.from, std::numeric_limits<float>::max())
                                     : medium.lengthBetween(source, x);
  const glm::vec3 arriving = glsl::airlight_scattered(medium.medium(), ray, point,
                                                      toLight + medium.length(piece.eye, piece.direction, t));
  return glm::dvec3(density * tint * arriving) * static_cast<double>(high - low);
}

/// One direction by the environment's radiance and one by the phase function, weighted by the power
/// heuristic; distances by what a homogeneous medium leaves of the light from there.
glm::dvec3 Airlight::ofEnvironment(const Piece& piece, const Sampler& sampler, uint32_t pair) const {
  const RayMedium& medium = rays_.medium();
  const glm::vec3& extinction = medium.medium().extinction;
  const float rate = medium.homogeneous() ? std::min({extinction.x, extinction.y, extinction.z}) : 0.f;
  const Distance at = distanceBetween(piece.from, piece.to, rate, sampler.pair(pair).x);
  const glm::vec3 x = piece.eye + at.metres * piece.direction;
  const float density = medium.density(x);
  if (density == 0.f) return glm::dvec3(0);
  const float g = medium.medium().g, toEye = medium.length(piece.eye, piece.direction, at.metres);
  const auto scattered = [&](const Arrival& arrival, float weight) {
    if (arrival.radiance == glm::vec3(0) ||
        rays_.shadowed(x, arrival.direction, std::numeric_limits<float>::infinity()))
      return glm::vec3(0);
    const float inside = toEye + medium.length(x, arrival.direction, std::numeric_limits<float>::max());
    return weight * arrival.radiance * glsl::medium_transmittance(medium.medium(), inside);
  };
  const auto phase = [&](const glm::vec3& towards) {
    return glsl::phase_function(g, -towards, -piece.direction);
  };
  const EnvironmentView view(*environment_);
  glm::vec3 sum(0);
  const Arrival seen = view.sample(sampler.pair(pair + 1));
  if (seen.pdf > 0.f) {
    const float scatters = phase(seen.direction);
    sum += scattered(seen, scatters * powerHeuristic(seen.pdf, scatters) / seen.pdf);
  }
  const Arrival met = view.towards(scatteredAbout(piece.direction, g, sampler.pair(pair + 2)));
  sum += scattered(met, powerHeuristic(phase(met.direction), met.pdf));
  return glm::dvec3(density * medium.medium().scattering * sum) * at.measure;
}

}  // namespace limn::reference
