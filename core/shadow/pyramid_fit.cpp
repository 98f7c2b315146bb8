#include "core/shadow/private/pyramid_fit.h"

#include <algorithm>
#include <cmath>

#include "core/shadow/convex.h"
#include "core/shadow/light_fit.h"

namespace limn::shadow {
namespace {

using glm::vec3;
using scene::Bounds;

/// Tangent of the half angle of the square pyramid around the corners; infinite where the box reaches beside
/// or behind the origin, 0 where it lies wholly behind.
float tangentOf(const std::array<vec3, 8>& box) {
  float tangent = 0, nearest = box[0].z, farthest = box[0].z;
  for (const vec3& p : box) {
    nearest = std::min(nearest, p.z);
    farthest = std::max(farthest, p.z);
  }
  if (!(farthest > 0)) return 0;
  if (!(nearest > 1e-6f * farthest)) return std::numeric_limits<float>::infinity();
  for (const vec3& p : box) tangent = std::max(tangent, std::max(std::abs(p.x), std::abs(p.y)) / p.z);
  return tangent;
}

/// Widens `range` by the depths of the part of the box inside the pyramid.
void addBox(const std::array<vec3, 8>& box, float tangent, Convex& solid, DepthRange& range) {
  float low = box[0].z, high = box[0].z;
  for (const vec3& p : box) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  if (high <= 0 || (low >= range.near && high <= range.far)) return;
  solid.setBox(box);
  for (const glm::vec4& plane : {glm::vec4(1, 0, tangent, 0), glm::vec4(-1, 0, tangent, 0),
                                 glm::vec4(0, 1, tangent, 0), glm::vec4(0, -1, tangent, 0)})
    solid.clip(plane);
  for (const vec3& p : solid.corners()) {
    range.near = std::min(range.near, std::max(p.z, 0.f));
    range.far = std::max(range.far, p.z);
  }
}

}  // namespace

MapAxes faceAxes(const MapAxes& a, uint32_t face) {
  switch (face) {
    case 1:
      return {a.y, a.z, a.x};
    case 2:
      return {a.z, a.y, -a.x};
    case 3:
      return {a.z, a.x, a.y};
    case 4:
      return {a.x, a.z, -a.y};
    case 5:
      return {a.y, a.x, -a.z};
    default:
      return a;
  }
}

std::span<const Bounds> boxesAround(const vec3& centre, float reach, std::span<const Bounds> boxes,
                                    std::vector<Bounds>& kept) {
  kept.assign(boxes.begin(), boxes.end());
  for (Bounds& box : kept) {
    box = {glm::max(box.low, centre - reach), glm::min(box.high, centre + reach)};
    if (glm::any(glm::greaterThan(box.low, box.high))) box = {};
  }
  return kept;
}

std::array<vec3, 8> corners(const Bounds& box, const vec3& origin, const MapAxes& axes) {
  std::array<vec3, 8> out = boxCorners(box);
  for (vec3& p : out) {
    p -= origin;
    p = {glm::dot(axes.x, p), glm::dot(axes.y, p), glm::dot(axes.z, p)};
  }
  return out;
}

float fittedTangent(const vec3& origin, const MapAxes& axes, std::span<const Bounds> boxes) {
  float tangent = 0;
  for (const Bounds& box : boxes) {
    if (!box.empty()) tangent = std::max(tangent, tangentOf(corners(box, origin, axes)));
  }
  return tangent;
}

DepthRange pyramidRange(const vec3& origin, const MapAxes& axes, uint32_t faceCount, uint32_t step,
                        float tangent, std::span<const Bounds> boxes) {
  DepthRange range;
  Convex solid;
  for (uint32_t face = 0; face < faceCount; ++face) {
    const MapAxes frame = faceAxes(axes, face * step);
    for (const Bounds& box : boxes) {
      if (!box.empty()) addBox(corners(box, origin, frame), tangent, solid, range);
    }
  }
  return range;
}

DepthRange widened(DepthRange range) {
  if (!(range.far > 0)) return {kLeastNear, 1};
  range.far *= 1.0001f;
  range.near = std::max(0.9999f * range.near, kLeastNear * range.far);
  return range;
}

}  // namespace limn::shadow
