#include "core/reference/private/specular_paths.h"

#include <algorithm>
#include <glm/glm.hpp>

#include "core/reference/private/optics.h"
#include "core/reference/reference.h"
#include "glsl/caustics/caustic_ray.glsl"

namespace limn::reference {
namespace {

glm::dvec3 doubles(const glm::vec3& v) {
  return glm::dvec3(v);
}

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// The first interface of a path as the camera sees it.
struct First {
  glsl::Optics optics;
  glsl::SpecularEvent event;
  bool inside;

  First(const Surface& s, const scene::Material& material)
      : optics(opticsOf(material, s.values.base_colour, s.values.metallic)),
        inside((s.values.flags & glsl::gbuffer_flag_back) != 0) {
    const glm::vec3& n =
        glm::dot(s.values.normal, s.view) > kLeastCosine ? s.values.normal : s.values.geometric_normal;
    event = glsl::specular_event(optics, -s.view, n, inside);
  }
};

}  // namespace

SpecularPaths::SpecularPaths(const RayScene& rays, int interfaces) : rays_(rays), interfaces_(interfaces) {}

bool SpecularPaths::many() const {
  return interfaces_ == kAllInterfaces;
}

SpecularEnd SpecularPaths::backgroundAlong(const Ray& ray, const glm::vec3& from) const {
  const glm::vec3 passes = rays_.medium().transmittanceToInfinity(from, ray.direction);
  return {ray.throughput * ray.atCamera * doubles(passes), std::nullopt,
          rays_.environment().radiance(ray.direction)};
}

/// At a surface that is not specular; `from`: where the medium begins, unless the way lies within a body.
SpecularEnd SpecularPaths::endAt(const Ray& ray, const Hit& hit, const glm::vec3& from,
                                 const std::optional<glsl::Optics>& body) const {
  std::optional<Surface> surface = surfaceAlong(rays_, hit, ray.direction);
  if (!surface) return {};
  const glm::vec3 passes = body ? glsl::optics_absorption(*body, hit.depth)
                                : rays_.medium().transmittanceBetween(from, surface->position);
  return {ray.throughput * (ray.atCamera / ray.here) * doubles(passes), surface};
}

/// The end of a ray that specular surfaces do not stop.
SpecularEnd SpecularPaths::matteAlong(const Ray& ray) const {
  Ray rest = ray;
  Hit hit;
  for (int i = 0; i < kMostEvents && rays_.nearest(rest.origin, rest.direction, hit); ++i) {
    if (!rays_.draws()[hit.draw].material->specularSurface())
      return endAt(ray, hit, ray.origin, std::nullopt);
    const Interface passed = interfaceAt(rays_, hit, rest.direction);
    rest.origin = passed.position - passed.rayOffset * passed.geometricNormal;
  }
  return backgroundAlong(ray, ray.origin);
}

/// From the front of a body to where it is left; behind a surface that bounds none, light goes on.
SpecularEnd SpecularPaths::throughBody(const Surface& seen, const glsl::Optics& optics, Ray ray) const {
  for (int interfaces = 1;; ++interfaces) {
    Hit hit;
    if (!rays_.nearest(ray.origin, ray.direction, hit) || hit.draw != seen.draw)
      return interfaces == 1 ? matteAlong(ray) : SpecularEnd{};
    if (interfaces >= interfaces_) return {};
    const Interface exit = interfaceAt(rays_, hit, ray.direction);
    if (!exit.back || !(glm::dot(exit.normal, -ray.direction) > kLeastCosine)) return {};
    const glsl::SpecularEvent event = glsl::specular_event(optics, ray.direction, exit.normal, true);
    ray.throughput *= doubles(glsl::optics_absorption(optics, hit.depth));
    const bool inside = event.refracted == glm::vec3(0);
    const float side = inside ? 1.f : -1.f;
    ray.origin = exit.position + side * exit.rayOffset * exit.geometricNormal;
    ray.direction = inside ? event.reflected : event.refracted;
    ray.throughput *= doubles(inside ? event.reflectance : event.transmittance);
    if (inside) continue;
    ray.here = 1;
    return matteAlong(ray);
  }
}

std::array<SpecularEnd, 2> SpecularPaths::imageSpace(const Surface& seen) const {
  const First first(seen, *rays_.draws()[seen.draw].material);
  const double before = glsl::squared_index(first.optics, first.inside);
  const auto ray = [&](const glm::vec3& direction, const glm::vec3& share, double here) {
    return Ray{seen.rayOrigin(direction), direction, doubles(share), before, here};
  };
  std::array<SpecularEnd, 2> ends;
  if (first.event.reflectance != glm::vec3(0))
    ends[0] = matteAlong(ray(first.event.reflected, first.event.reflectance, before));
  if (first.event.refracted == glm::vec3(0) || first.event.transmittance == glm::vec3(0)) return ends;
  const Ray refracted =
      ray(first.event.refracted, first.event.transmittance, glsl::squared_index(first.optics, !first.inside));
  const bool straight = first.inside || !(first.optics.thickness > 0);
  ends[1] = straight ? matteAlong(refracted) : throughBody(seen, first.optics, refracted);
  return ends;
}

SpecularEnd SpecularPaths::sample(const Surface& seen, const Sampler& sampler) const {
  const First first(seen, *rays_.draws()[seen.draw].material);
  glsl::Optics optics = first.optics;
  bool back = first.inside;
  glsl::SpecularEvent event = first.event;
  const double before = glsl::squared_index(optics, back);
  Ray ray{seen.position, -seen.view, glm::dvec3(1), before, before};
  glm::vec3 position = seen.position, away = seen.rayOffset * seen.values.geometric_normal;
  for (uint32_t i = 0; i < kMostEvents; ++i) {
    const glm::vec2 u = sampler.pair(firstPair + i);
    const glm::dvec3 reflected = doubles(event.reflectance),
                     passing = event.refracted == glm::vec3(0) ? glm::dvec3(0) : doubles(event.transmittance);
    const double both = largest(reflected) + largest(passing);
    if (!(both > 0)) return {};
    const double probability = largest(reflected) / both;
    const bool mirrored = static_cast<double>(u.x) < probability;
    ray.throughput *= mirrored ? reflected / probability : passing / (1 - probability);
    ray.direction = mirrored ? event.reflected : event.refracted;
    if (!mirrored)
      ray.here = ray.here / glsl::squared_index(optics, back) * glsl::squared_index(optics, !back);
    if (i >= kFirstEventRoulette) {
      const double survival = std::min(largest(ray.throughput), 1.0);
      if (static_cast<double>(u.y) >= survival) return {};
      ray.throughput /= survival;
    }
    ray.origin = position + (mirrored ? 1.f : -1.f) * away;
    Hit hit;
    if (!rays_.nearest(ray.origin, ray.direction, hit)) return backgroundAlong(ray, ray.origin);
    const std::optional<glsl::Optics> body = bodyBehind(optics, back, mirrored);
    const scene::Material& material = *rays_.draws()[hit.draw].material;
    if (!material.specularSurface()) return endAt(ray, hit, ray.origin, body);
    const Interface met = interfaceAt(rays_, hit, ray.direction);
    if (!(glm::dot(met.normal, -ray.direction) > kLeastCosine)) return {};
    optics = opticsOf(material, met.baseColour, met.metallic);
    back = met.back;
    const std::optional<glsl::Optics> crossed = bodyBefore(optics, back, body);
    ray.throughput *= doubles(crossed ? glsl::optics_absorption(*crossed, hit.depth)
                                      : rays_.medium().transmittanceBetween(ray.origin, met.position));
    event = glsl::specular_event(optics, ray.direction, met.normal, back);
    position = met.position;
    away = met.rayOffset * met.geometricNormal;
  }
  return {};
}

}  // namespace limn::reference
