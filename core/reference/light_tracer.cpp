#include "core/reference/private/light_tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/reference/private/optics.h"
#include "core/reference/private/specular_paths.h"
#include "core/scene/light_texture.h"
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/light/light_intensity.glsl"
#include "glsl/numeric/geometry.glsl"

namespace limn::reference {
namespace {

constexpr int kScatterPoints = 4;            // on each segment in the medium
constexpr size_t kMostFilmPixels = 1 << 22;  // of all films together, unless two are more
constexpr size_t kMostShares = 1 << 20;      // of paths that go to an object, of all lights together
constexpr float kWiden = 1.001f;             // of spheres, for rounding
constexpr float kAllDirections = 2;          // 1 - cosine of half of a full turn

/// Flux that arrives from a light in the direction of the objects, per sample, before the light's own
/// directional factors.
struct Aim {
  glm::vec3 origin, direction;
  float measure;  ///< solid angle (sr), or area across parallel light (m^2), that the sample stands for
};

/// 1 - cosine of the half angle of a cone around a sphere; kAllDirections from within it, and nearly so.
float capAround(float distance, float radius) {
  const float ratio = distance > 0 ? radius / distance : 2.f;
  return ratio < 0.999f ? ratio * ratio / (1 + std::sqrt(1 - ratio * ratio)) : kAllDirections;
}

/// The measure of what light from the light's centre is sent to around a sphere, as Aim has it.
float measureAround(const glsl::Light& light, const glm::vec3& centre, float radius) {
  if (light.type == glsl::light_directional) return glsl::pi * radius * radius;
  return 2 * glsl::pi * capAround(glm::distance(light.position, centre), radius);
}

Aim aimAt(const glsl::Light& light, const glm::vec3& centre, float radius, float away, glm::vec2 u,
          glm::vec2 onLight) {
  if (light.type == glsl::light_directional) {
    const glm::vec3 direction = discDirection(light, onLight);
    const glm::vec2 disc = radius * glsl::sample_disc(u);
    const glm::vec3 across = glsl::from_local(glsl::frame_around(direction), glm::vec3(disc, 0));
    return {centre + across - away * direction, direction, glsl::pi * radius * radius};
  }
  const glm::vec3 origin = lightPoint(light, onLight), towards = centre - origin;
  const float distance = glm::length(towards);
  const float cap = capAround(distance, radius);
  if (cap == kAllDirections) {
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(1 - z * z, 0.f)), angle = 2 * glsl::pi * u.y;
    return {origin, {r * std::cos(angle), r * std::sin(angle), z}, 4 * glsl::pi};
  }
  const float down = cap * u.x, lateral = std::sqrt(down * (2 - down)), angle = 2 * glsl::pi * u.y;
  const glm::vec3 local(lateral * std::cos(angle), lateral * std::sin(angle), 1 - down);
  return {origin, glm::normalize(glsl::from_local(glsl::frame_around(towards / distance), local)),
          2 * glsl::pi * cap};
}

/// The lights that are asked for, without those that stand for the environment.
std::vector<glsl::Light> ownAmong(const Request& request) {
  const AskedLights asked = askedLights(request);
  const int last = std::min(asked.last, ownLights(request.pose));
  const auto begin = request.pose.lights.begin();
  return {begin + std::min(asked.first, last), begin + last};
}

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace

struct LightTracer::Film {
  std::vector<glm::dvec3>& pixels;
  void add(size_t pixel, const glm::dvec3& value) { pixels[pixel] += value; }
};

/// Light that meets a specular object.
struct LightTracer::Path {
  Interface surface;
  glm::vec3 direction{0};  ///< unit, of propagation
  glm::vec3 flux{0};       ///< W
};

LightTracer::LightTracer(const View& view, const Request& request)
    : view_(view),
      request_(request),
      worldToView_(view.frame.world_to_view),
      spacing_(glm::length(glm::dvec3(glm::vec3(view.frame.view_ray_dx))),
               glm::length(glm::dvec3(glm::vec3(view.frame.view_ray_dy)))),
      lights_(ownAmong(request)),
      medium_(view.rays.medium().medium()),
      media_(request.term != Term::caustic && medium_.scattering != glm::vec3(0)),
      surfaces_(request.term != Term::media) {
  for (size_t i = 0; i < request.pose.instances.size(); ++i) {
    const scene::Material* material = view.rays.draws()[i].material;
    if (!material || !material->specularSurface()) continue;
    const scene::Bounds box = scene::instanceBounds(request.scene, request.pose, request.pose.instances[i]);
    if (box.empty()) continue;
    objects_.add(box);
    bodies_.push_back({box.centre(), kWiden * box.radius(), static_cast<uint32_t>(i)});
  }
  all_ = {objects_.centre(), kWiden * objects_.radius()};
  if (!media_ && !surfaces_) lights_.clear();
  upTo_.resize(lights_.size());
  if (bodies_.size() * lights_.size() <= kMostShares)
    for (size_t i = 0; i < lights_.size(); ++i) upTo_[i] = sharesOf(lights_[i]);
  const size_t pixels = view.pixelCount();
  const size_t films = std::clamp<size_t>(kMostFilmPixels / std::max<size_t>(pixels, 1), 2, 16) / 2 * 2;
  if (present()) films_.assign(films, std::vector<glm::dvec3>(pixels));
}

/// Returns what upTo_ holds for a light. Half of its paths go to bodies in proportion to the light that their
/// spheres get, and half to all bodies alike, so that none is left out. Where these spheres are about as
/// large together as the one around all of them, paths go to that.
std::vector<float> LightTracer::sharesOf(const glsl::Light& light) const {
  std::vector<double> measures;
  double sum = 0;
  for (const Target& body : bodies_) {
    measures.push_back(double{measureAround(light, body.centre, body.radius)});
    sum += measures.back();
  }
  if (!(sum > 0 && 2 * sum < double{measureAround(light, all_.centre, all_.radius)})) return {};
  std::vector<float> upTo;
  double reached = 0;
  for (const double measure : measures) {
    reached += 0.5 * (measure / sum + 1 / static_cast<double>(measures.size()));
    upTo.push_back(static_cast<float>(std::round(reached * 0x1p24) * 0x1p-24));
  }
  upTo.back() = 1;
  return upTo;
}

void LightTracer::trace(uint32_t first, uint32_t count, std::vector<Sums>& sums) {
  const size_t pixels = view_.pixelCount(), perHalf = films_.size() / 2;
  const uint64_t paths = uint64_t{count} * pixels, start = uint64_t{first} * pixels;
  tbb::parallel_for(size_t{0}, films_.size(), [&](size_t f) {
    std::ranges::fill(films_[f], glm::dvec3(0));
    Film film{films_[f]};
    const uint32_t half = f % 2;
    const size_t part = f / 2;
    for (uint64_t i = start + paths * part / perHalf; i < start + paths * (part + 1) / perHalf; ++i) {
      if (request_.stop.stop_requested()) return;
      const Sampler sampler = pathSampler(request_.seed, half, i);
      Path path;
      if (!emit(sampler, i, path)) continue;
      if (request_.interfaces == kAllInterfaces)
        wander(path, sampler, film);
      else
        follow(path, sampler, film);
    }
  });
  tbb::parallel_for(size_t{0}, pixels, [&](size_t pixel) {
    for (size_t f = 0; f < films_.size(); ++f) {
      const glm::dvec3 value = films_[f][pixel] / static_cast<double>(pixels);
      for (int c = 0; c < 3; ++c) sums[2 * pixel + f % 2][static_cast<size_t>(c)] += value[c];
    }
  });
}

bool LightTracer::emit(const Sampler& sampler, uint64_t index, Path& path) const {
  const size_t count = lights_.size();
  const glsl::Light& light = lights_[index % count];
  const std::vector<float>& upTo = upTo_[index % count];
  const Target* target = &all_;
  float share = 1;
  if (!upTo.empty()) {
    const auto chosen = std::ranges::upper_bound(upTo, sampler.pair(2).y);
    target = &bodies_[static_cast<size_t>(chosen - upTo.begin())];
    share = *chosen - (chosen == upTo.begin() ? 0.f : *std::prev(chosen));
  }
  const float scene = medium_.ball.radius, offset = 0x1p-18f * scene;
  const Aim aim = aimAt(light, target->centre, target->radius, 4 * scene, sampler.pair(0), sampler.pair(1));
  Hit hit;
  if (!view_.rays.nearest(aim.origin + offset * aim.direction, aim.direction, hit)) return false;
  if (!view_.rays.draws()[hit.draw].material->specularSurface()) return false;
  // What lies before the body counts where it is aimed at itself.
  if (target->draw != glsl::no_instance && hit.draw != target->draw) return false;
  path.surface = interfaceAt(view_.rays, hit, aim.direction);
  path.direction = aim.direction;
  const glm::vec3& p = path.surface.position;
  path.flux = glsl::light_point_intensity(light, aim.origin, p, 1) *
              (aim.measure * static_cast<float>(count) / share);
  path.flux *= glsl::light_fluence(light);
  path.flux *= scene::lightTextureAt(view_.rays.scene(), light, p);
  const glsl::Optics optics = opticsOf(*view_.rays.draws()[hit.draw].material);
  const bool parallel = light.type == glsl::light_directional;
  if (path.surface.back && !parallel && optics.thickness > 0)  // from within a body, which no medium fills
    path.flux *= glsl::optics_absorption(optics, glm::distance(aim.origin, p));
  else
    path.flux *= parallel ? view_.rays.medium().transmittanceToInfinity(p, -aim.direction)
                          : view_.rays.medium().transmittanceBetween(aim.origin, p);
  return path.flux != glm::vec3(0) && glm::dot(path.surface.normal, -aim.direction) > kLeastCosine;
}

void LightTracer::follow(const Path& path, const Sampler& sampler, Film& film) const {
  const Interface& s = path.surface;
  const glsl::Optics optics = opticsOf(*view_.rays.draws()[s.draw].material);
  const glsl::SpecularEvent event = glsl::specular_event(optics, path.direction, s.normal, s.back);
  const glm::vec3 before = s.position + s.rayOffset * s.geometricNormal;
  const auto adjoint = [&](const glm::vec3& leaving) {
    return glsl::shading_flux(s.normal, s.geometricNormal, path.direction, leaving);
  };
  if (!s.back || !(optics.thickness > 0))  // a sheet has no within
    segment(before, event.reflected, path.flux * event.reflectance * adjoint(event.reflected), sampler, film);
  if (event.refracted == glm::vec3(0)) return;
  const glm::vec3 passing = path.flux * event.transmittance * adjoint(event.refracted);
  if (passing == glm::vec3(0)) return;
  if (s.back || !(optics.thickness > 0)) {
    segment(s.position - s.rayOffset * s.geometricNormal, event.refracted, passing, sampler, film);
    return;
  }
  refract(path, optics, passing, event.refracted, sampler, film);
}

/// Through the body behind the interface; behind one that bounds no body light stays in the medium.
void LightTracer::refract(const Path& path, const glsl::Optics& optics, const glm::vec3& flux,
                          const glm::vec3& direction, const Sampler& sampler, Film& film) const {
  const Interface& s = path.surface;
  const glm::vec3 start = s.position - s.rayOffset * s.geometricNormal;
  Hit hit;
  if (!view_.rays.nearest(start, direction, hit) || hit.draw != s.draw) {
    segment(start, direction, flux, sampler, film);
    return;
  }
  const Interface exit = interfaceAt(view_.rays, hit, direction);
  if (!exit.back || !(glm::dot(exit.normal, -direction) > kLeastCosine)) return;
  const glsl::SpecularEvent event = glsl::specular_event(optics, direction, exit.normal, true);
  if (event.refracted == glm::vec3(0)) return;
  const float adjoint = glsl::shading_flux(exit.normal, exit.geometricNormal, direction, event.refracted);
  segment(exit.position - exit.rayOffset * exit.geometricNormal, event.refracted,
          flux * event.transmittance * adjoint * glsl::optics_absorption(optics, hit.depth), sampler, film);
}

/// Without limit: off and through smooth interfaces, at random, until something else is met.
void LightTracer::wander(const Path& path, const Sampler& sampler, Film& film) const {
  Interface s = path.surface;
  glm::vec3 direction = path.direction, flux = path.flux;
  const float sent = largest(flux);
  for (uint32_t i = 0; i < kMostEvents; ++i) {
    const glsl::Optics optics = opticsOf(*view_.rays.draws()[s.draw].material, s.baseColour, s.metallic);
    const glsl::SpecularEvent event = glsl::specular_event(optics, direction, s.normal, s.back);
    const auto share = [&](const glm::vec3& leaving, const glm::vec3& factor) {
      return leaving == glm::vec3(0)
                 ? glm::vec3(0)
                 : factor * glsl::shading_flux(s.normal, s.geometricNormal, direction, leaving);
    };
    const glm::vec3 reflected = share(event.reflected, event.reflectance),
                    passing = share(event.refracted, event.transmittance);
    const float both = largest(reflected) + largest(passing);
    if (!(both > 0)) return;
    const glm::vec2 u = sampler.pair(SpecularPaths::firstPair + i);
    const float probability = largest(reflected) / both;
    const bool mirrored = u.x < probability;
    flux *= mirrored ? reflected / probability : passing / (1 - probability);
    if (i >= kFirstEventRoulette) {
      const float survival = std::min(largest(flux) / sent, 1.f);
      if (u.y >= survival) return;
      flux /= survival;
    }
    direction = mirrored ? event.reflected : event.refracted;
    const glm::vec3 from = s.position + (mirrored ? 1.f : -1.f) * s.rayOffset * s.geometricNormal;
    Hit hit;
    if (!view_.rays.nearest(from, direction, hit))
      return arrive(from, direction, flux, nullptr, sampler, film);
    const std::optional<glsl::Optics> body = bodyBehind(optics, s.back, mirrored);
    const scene::Material& material = *view_.rays.draws()[hit.draw].material;
    if (!material.specularSurface()) {
      if (!body) return arrive(from, direction, flux, &hit, sampler, film);
      if (surfaces_) reflect(hit, direction, flux * glsl::optics_absorption(*body, hit.depth), film);
      return;
    }
    s = interfaceAt(view_.rays, hit, direction);
    const auto crossed = bodyBefore(opticsOf(material, s.baseColour, s.metallic), s.back, body);
    if (crossed) {
      flux *= glsl::optics_absorption(*crossed, hit.depth);
    } else {
      arrive(from, direction, flux, &hit, sampler, film);  // the medium alone: it reflects nothing
      flux *= view_.rays.medium().transmittanceBetween(from, s.position);
    }
    if (!(glm::dot(s.normal, -direction) > kLeastCosine)) return;
  }
}

/// Through the medium until something is met.
void LightTracer::segment(const glm::vec3& from, const glm::vec3& direction, const glm::vec3& flux,
                          const Sampler& sampler, Film& film) const {
  if (flux == glm::vec3(0)) return;
  Hit hit;
  const bool ends = view_.rays.nearest(from, direction, hit);
  arrive(from, direction, flux, ends ? &hit : nullptr, sampler, film);
}

/// Through the medium to `hit`, or to where it ends.
void LightTracer::arrive(const glm::vec3& from, const glm::vec3& direction, const glm::vec3& flux,
                         const Hit* hit, const Sampler& sampler, Film& film) const {
  const RayMedium& medium = view_.rays.medium();
  const glm::vec2 range = medium.range(from, direction);
  const float begin = std::max(range.x, 0.f);
  const float reach = std::min(range.y, hit ? hit->depth : std::numeric_limits<float>::max()) - begin;
  if (media_ && reach > 0) {
    const float u = sampler.pair(2).x;
    for (int i = 0; i < kScatterPoints; ++i) {
      const float l = begin + reach * (static_cast<float>(i) + u) / kScatterPoints;
      scatter(from, direction, l, reach / kScatterPoints, flux, film);
    }
  }
  if (surfaces_ && hit)
    reflect(*hit, direction, flux * medium.transmittance(from, direction, hit->depth), film);
}

/// The pixel that shows x, its depth, and one over the pixel's solid angle (1/sr).
bool LightTracer::project(const glm::vec3& x, size_t& pixel, float& depth, double& perSolidAngle) const {
  const glm::dvec4 v = worldToView_ * glm::dvec4(glm::dvec3(x), 1);
  depth = static_cast<float>(-v.z);
  if (!(depth > view_.near)) return false;
  const double column = std::floor(v.x / -v.z / spacing_.x + 0.5 * view_.width);
  const double row = std::floor(v.y / -v.z / spacing_.y + 0.5 * view_.height);
  if (!(column >= 0 && column < view_.width && row >= 0 && row < view_.height)) return false;
  pixel = static_cast<size_t>(row) * static_cast<size_t>(view_.width) + static_cast<size_t>(column);
  const double cosine = -v.z / glm::length(glm::dvec3(v));
  perSolidAngle = 1 / (cosine * cosine * cosine * spacing_.x * spacing_.y);
  return true;
}

/// At `metres` from where the light of that flux starts, on a piece of that length.
void LightTracer::scatter(const glm::vec3& from, const glm::vec3& direction, float metres, float length,
                          const glm::vec3& flux, Film& film) const {
  const glm::vec3 x = from + metres * direction;
  size_t pixel = 0;
  float depth = 0;
  double perSolidAngle = 0;
  if (!project(x, pixel, depth, perSolidAngle)) return;
  if (view_.shows(pixel) && depth > view_.hits[pixel].depth) return;
  const RayMedium& medium = view_.rays.medium();
  const float density = medium.density(x);
  if (density == 0.f) return;
  const glm::vec3 eye(view_.frame.camera_position), towards = eye - x;
  const float distance = glm::length(towards);
  const glm::vec3 arriving = flux * medium.transmittance(from, direction, metres) * length;
  const glm::vec3 leaving = arriving * (density * medium_.scattering) * medium.transmittanceBetween(x, eye) *
                            glsl::phase_function(medium_.g, direction, towards / distance);
  film.add(pixel, glm::dvec3(leaving) * (perSolidAngle / (static_cast<double>(distance) * distance)));
}

void LightTracer::reflect(const Hit& hit, const glm::vec3& direction, const glm::vec3& flux,
                          Film& film) const {
  const std::optional<Surface> met = surfaceAlong(view_.rays, hit, direction);
  if (!met || met->specular() || !met->relief.lit(-direction)) return;
  const glm::vec3 eye(view_.frame.camera_position), towards = eye - met->position;
  const float distance = glm::length(towards),
              cosine = glm::dot(met->values.geometric_normal, towards) / distance;
  // Flux counts per area of the triangle; the light's cosine is that with the shading normal (Veach 1997,
  // section 5.3).
  const float lit = glm::dot(met->values.normal, -direction),
              crossed = glm::dot(met->values.geometric_normal, -direction);
  if (!(lit > 0 && crossed > 0)) return;
  size_t pixel = 0;
  float depth = 0;
  double perSolidAngle = 0;
  if (!(cosine > 0) || !project(met->position, pixel, depth, perSolidAngle) || !view_.shows(pixel)) return;
  if (view_.rays.hidden(view_.frame, view_.near, view_.pixel(pixel), met->rayOrigin(towards))) return;
  const glm::vec3 reflected = flux * met->f(towards / distance, -direction) * (cosine * lit / crossed);
  film.add(pixel, glm::dvec3(reflected * view_.rays.medium().transmittanceBetween(met->position, eye)) *
                      (perSolidAngle / (static_cast<double>(distance) * distance)));
}

}  // namespace limn::reference
