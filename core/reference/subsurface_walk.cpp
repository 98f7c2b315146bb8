#include "core/reference/private/subsurface_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace limn::reference {
namespace {

/// Ends walks that would not end by themselves. In a half space without absorption 1 in 1000 walks is longer.
constexpr uint32_t kMostSteps = 1u << 20;
/// Below this weight half of the walks end, and the others carry their light.
constexpr double kLeastWeight = 0.125;

/// A walk's random numbers, in their order.
struct Numbers {
  const Sampler& sampler;
  uint32_t pair;
  glm::dvec2 next() { return {sampler.pair(pair++)}; }
};

/// The direction inside, with z along the outward normal, of light that leaves at that cosine.
double refractedCosine(double cosine, double eta) {
  return -std::sqrt(std::max(0.0, 1 - (1 - cosine * cosine) / (eta * eta)));
}

/// Reflectance of the boundary from inside.
double reflectanceInside(double cosine, double eta) {
  const double sine2 = eta * eta * (1 - cosine * cosine);
  if (sine2 >= 1) return 1;
  return static_cast<double>(
      glsl::fresnel(static_cast<float>(std::sqrt(1 - sine2)), static_cast<float>(eta), 0.f));
}

glm::dvec3 onSphere(const glm::dvec2& u) {
  const double z = 1 - 2 * u.x, ring = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * M_PI * u.y;
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

/// All below the plane z = 0.
struct HalfSpace {
  double z = 0;

  bool meets(const glm::dvec3& direction, double flight) const { return z + flight * direction.z > 0; }
  bool closed() const { return true; }
  glm::dvec3 inwards() const { return {0, 0, -1}; }
  void stay() { z = 0; }
  void move(const glm::dvec3& way) { z = std::min(z + way.z, 0.0); }
};

/// The inside of one draw.
struct Body {
  const RayScene& rays;
  uint32_t draw;
  glm::vec3 position;
  Hit hit{};
  Interface met{};

  bool meets(const glm::dvec3& direction, double flight) {
    const glm::vec3 along(direction);
    // Most flights end far from the boundary: a ray that ends there, too, leaves out most of the mesh.
    // Rounding must not end it earlier.
    const float reach = static_cast<float>(flight) * (1 + 0x1p-20f);
    if (!rays.nearestOfBody(draw, position, along, 0.f, reach, hit)) return false;
    if (static_cast<double>(hit.depth) > flight) return false;
    met = interfaceAt(rays, hit, along);
    return true;
  }
  bool closed() const { return met.back; }
  glm::dvec3 inwards() const { return glm::dvec3(met.geometricNormal); }
  void stay() { position = met.position + met.rayOffset * met.geometricNormal; }
  void move(const glm::dvec3& way) { position = glm::vec3(glm::dvec3(position) + way); }
};

/// Walks until the boundary lets the light out and returns its weight; the body then knows where.
template <class Inside>
double walk(Inside& inside, glm::dvec3 direction, const WalkMatter& matter, Numbers numbers) {
  double weight = 1;
  for (uint32_t step = 0; step < kMostSteps && weight > 0; ++step) {
    const glm::dvec2 u = numbers.next();
    const double flight = -std::log1p(-u.x) / matter.extinction;
    if (inside.meets(direction, flight)) {
      if (!inside.closed()) return 0;
      const glm::dvec3 inwards = inside.inwards();
      const double cosine = std::clamp(-glm::dot(inwards, direction), 0.0, 1.0);
      if (u.y >= reflectanceInside(cosine, matter.eta)) return weight;
      direction = glm::normalize(direction + 2 * cosine * inwards);
      inside.stay();
      continue;
    }
    inside.move(flight * direction);
    weight *= matter.albedo;
    if (weight < kLeastWeight) weight = u.y < 0.5 ? 2 * weight : 0;
    direction = onSphere(numbers.next());
  }
  return 0;
}

}  // namespace

WalkEnd walkThroughBody(const RayScene& rays, const Surface& from, const WalkMatter& matter,
                        const Sampler& sampler, uint32_t pair) {
  const glm::dvec3 normal(from.values.geometric_normal), view(from.view);
  const double cosine = std::clamp(glm::dot(normal, view), 0.0, 1.0);
  const glm::dvec3 direction =
      glm::normalize((cosine * normal - view) / matter.eta + refractedCosine(cosine, matter.eta) * normal);
  Body body{.rays = rays,
            .draw = from.draw,
            .position = from.position - from.rayOffset * from.values.geometric_normal};
  const double weight = walk(body, direction, matter, {sampler, pair});
  return {weight, body.hit};
}

double walkThroughHalfSpace(double cosine, const WalkMatter& matter, const Sampler& sampler, uint32_t pair) {
  const double z = refractedCosine(std::clamp(cosine, 0.0, 1.0), matter.eta);
  HalfSpace space;
  return walk(space, {std::sqrt(1 - z * z), 0, z}, matter, {sampler, pair});
}

}  // namespace limn::reference
