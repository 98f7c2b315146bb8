#include "core/shadow/private/window_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/shadow/private/pyramid_fit.h"

namespace limn::shadow {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

constexpr float kInfinite = std::numeric_limits<float>::max();
/// Of the far plane: what is nearer to a perspective map's origin has no place in it.
constexpr float kLeastDepth = 1e-6f;
/// A window's edges and depths are rounded to 1/32 to 1/64 of its size and to 1/16 of an octave, both counted
/// from those of the whole map, so that scenes of every scale are cut the same.
constexpr int kWindowSteps = 5, kDepthSteps = 16;
/// Of the whole map's side: no window is smaller.
constexpr float kLeastSide = 1e-4f;

/// Straight edges: low(z) = low.x + low.y z <= x <= high.x + high.y z, and the same of y.
struct Wedge {
  std::array<vec4, 4> planes;
};

Wedge pyramid(const MapEye& eye, const MapWindow& w) {
  if (eye.perspective)
    return {{vec4(1, 0, -w.low.x, 0), vec4(-1, 0, w.high.x, 0), vec4(0, 1, -w.low.y, 0),
             vec4(0, -1, w.high.y, 0)}};
  return {
      {vec4(1, 0, 0, -w.low.x), vec4(-1, 0, 0, w.high.x), vec4(0, 1, 0, -w.low.y), vec4(0, -1, 0, w.high.y)}};
}

/// All lines from receivers to points of the light: the hull of both.
Wedge linesToLight(const MapEye& eye, const MapWindow& receivers) {
  Wedge wedge = pyramid(eye, receivers);
  const std::array<float, 4> edges{receivers.low.x, receivers.high.x, receivers.low.y, receivers.high.y};
  const float toLight = receivers.far - eye.spread.z;
  for (size_t i = 0; i < 4; ++i) {
    const float spread = i < 2 ? eye.spread.x : eye.spread.y;
    vec4& plane = wedge.planes[i];
    if (!eye.perspective) {  // spread (far - z) wider at depth z
      plane.z -= spread;
      plane.w += spread * receivers.far;
      continue;
    }
    // No point of the light, up to spread.z before or behind its centre, lies farther outside of the edge.
    const float outside = spread + std::abs(edges[i]) * eye.spread.z;
    // Of that (far - z) / (far - spread.z) is left at depth z, or all where receivers lie among its points.
    plane.z -= toLight > 0 ? outside / toLight : 0;
    plane.w += toLight > 0 ? outside * (receivers.far / toLight) : outside;
  }
  return wedge;
}

void clipTo(Convex& solid, const Wedge& wedge, float near, float far) {
  const auto clip = [&](const vec4& plane) {
    if (!solid.empty()) solid.clip(plane);
  };
  clip({0, 0, 1, -near});
  clip({0, 0, -1, far});
  for (const vec4& plane : wedge.planes) clip(plane);
}

void add(MapWindow& window, bool perspective, const vec3& p) {
  const vec2 at = perspective ? vec2(p) / p.z : vec2(p);
  window.low = glm::min(window.low, at);
  window.high = glm::max(window.high, at);
  window.near = std::min(window.near, p.z);
  window.far = std::max(window.far, p.z);
}

MapWindow nothing() {
  return {vec2(kInfinite), vec2(-kInfinite), kInfinite, -kInfinite};
}

/// Whether the window holds all of the points, so that nothing between them widens it.
bool holds(const MapWindow& window, bool perspective, std::span<const vec3> points) {
  return std::ranges::all_of(points, [&](const vec3& p) {
    if (p.z < window.near || p.z > window.far) return false;
    const vec2 at = perspective ? vec2(p) / p.z : vec2(p);
    return at.x >= window.low.x && at.y >= window.low.y && at.x <= window.high.x && at.y <= window.high.y;
  });
}

/// What clipTo() leaves of all that lies between some points.
enum class Left { all, some, nothing };
Left leftOf(std::span<const vec3> points, const Wedge& wedge, float near, float far) {
  Left left = Left::all;
  const auto cut = [&](const auto& height) {
    const auto kept = std::ranges::count_if(points, [&](const vec3& p) { return height(p) >= 0; });
    if (kept < std::ssize(points)) left = kept > 0 ? Left::some : Left::nothing;
    return left == Left::nothing;
  };
  if (cut([&](const vec3& p) { return p.z - near; }) || cut([&](const vec3& p) { return far - p.z; }))
    return left;
  for (const vec4& plane : wedge.planes)
    if (cut([&](const vec3& p) { return glm::dot(vec3(plane), p) + plane.w; })) break;
  return left;
}

vec3 inAxes(const MapAxes& axes, const vec3& r) {
  return {glm::dot(axes.x, r), glm::dot(axes.y, r), glm::dot(axes.z, r)};
}

constexpr MapAxes kOwnAxes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// What lies before the light, in the axes of a face of its half cube.
vec4 beforeLight(uint32_t face) {
  return vec4(inAxes(faceAxes(kOwnAxes, face), kOwnAxes.z), 0);
}

}  // namespace

bool fitWindow(const MapEye& eye, const VisibleScene& scene, uint32_t skip, const MapWindow& whole,
               MapWindow& window, std::vector<vec3>& receivers) {
  const auto local = [&](const vec3& p) {
    const vec3 r = p - eye.origin;
    return vec3(glm::dot(eye.axes.x, r), glm::dot(eye.axes.y, r), glm::dot(eye.axes.z, r));
  };
  const float near = eye.perspective ? kLeastDepth * whole.far : whole.near;
  Convex solid;
  receivers.clear();
  const Wedge limits = pyramid(eye, whole);
  for (const VisiblePart& part : scene.visible()) {
    if (part.instance == skip) continue;
    const size_t first = receivers.size();
    for (const vec3& p : part.corners) receivers.push_back(local(p));
    const Left left = leftOf(std::span(receivers).subspan(first), limits, near, whole.far);
    if (left == Left::all) continue;
    receivers.resize(first);
    if (left == Left::nothing) continue;
    solid.assign(part.solid, local);
    clipTo(solid, limits, near, whole.far);
    receivers.insert(receivers.end(), solid.corners().begin(), solid.corners().end());
  }
  window = nothing();
  for (const vec3& p : receivers) add(window, eye.perspective, p);
  if (!(window.far > 0 && window.low.x <= window.high.x)) return false;
  const float far = window.far;
  const Wedge lines = linesToLight(eye, window);
  for (const ScenePart& part : scene.parts()) {
    if (part.instance == skip) continue;
    std::array<vec3, 8> corners = boxCorners(part.bounds);
    for (vec3& p : corners) p = local(p);
    if (holds(window, eye.perspective, corners) || leftOf(corners, lines, near, far) == Left::nothing)
      continue;
    solid.setBox(corners);
    clipTo(solid, lines, near, far);
    for (const vec3& p : solid.corners()) add(window, eye.perspective, p);
  }
  window.low = glm::max(window.low, whole.low);
  window.high = glm::min(window.high, whole.high);
  return true;
}

void findFaceReceivers(const vec3& origin, const MapAxes& axes, const VisibleScene& scene, uint32_t skip,
                       uint32_t faces, const vec3& reach, const MapWindow& whole, FaceReceivers& receivers) {
  Convex solid;
  for (uint32_t face = 0; face < faces; ++face) {
    const MapAxes turned = faceAxes(kOwnAxes, face), own = faceAxes(axes, face);
    const vec3 around = inAxes({glm::abs(turned.x), glm::abs(turned.y), glm::abs(turned.z)}, reach);
    // |x| <= z wherever in reach the pyramid's apex lies.
    Wedge limits = pyramid({origin, own}, whole);
    for (size_t i = 0; i < 4; ++i) limits.planes[i].w += (i < 2 ? around.x : around.y) + around.z;
    receivers[face].clear();
    for (const VisiblePart& part : scene.visible()) {
      if (part.instance == skip) continue;
      solid.assign(part.solid, [&](const vec3& p) { return inAxes(own, p - origin); });
      clipTo(solid, limits, kLeastDepth * whole.far - around.z, whole.far + around.z);
      if (faces == 5 && !solid.empty()) solid.clip(beforeLight(face));
      receivers[face].insert(receivers[face].end(), solid.corners().begin(), solid.corners().end());
    }
  }
}

MapWindow shiftedFaceWindow(std::span<const vec3> receivers, const vec3& offset, const MapWindow& whole) {
  MapWindow shifted = nothing();
  for (const vec3& p : receivers) {
    // Beside the point the tangents of what lies between corners have no bounds.
    if (p.z - offset.z < kLeastDepth * whole.far) return whole;
    add(shifted, true, p - offset);
  }
  shifted.low = glm::max(shifted.low, whole.low);
  shifted.high = glm::min(shifted.high, whole.high);
  return shifted;
}

MapWindow shiftedWindow(std::span<const vec3> receivers, const vec2& offset) {
  MapWindow shifted = nothing();
  for (const vec3& p : receivers) add(shifted, true, {vec2(p) - offset, p.z});
  return shifted;
}

MapWindow steadyWindow(const MapWindow& window, const MapWindow& whole, int size) {
  const float wholeSide = whole.high.x - whole.low.x;
  const vec2 extent = window.high - window.low;
  const float needed =
      std::max({extent.x, extent.y, kLeastSide * wholeSide}) * (1 + 4 / static_cast<float>(size));
  const float step = std::exp2(std::floor(std::log2(needed / wholeSide)) - kWindowSteps) * wholeSide;
  const float side = (std::ceil(needed / step) + 1) * step;
  if (side >= wholeSide) return whole;
  const vec2 middle = glm::round(0.5f * (window.low + window.high) / step) * step;
  const auto rounded = [&](float depth, bool up) {
    const float octaves = static_cast<float>(kDepthSteps) * std::log2(depth / whole.far);
    return whole.far *
           std::exp2((up ? std::ceil(octaves) : std::floor(octaves)) / static_cast<float>(kDepthSteps));
  };
  return {middle - 0.5f * side, middle + 0.5f * side,
          std::max(rounded(0.9999f * window.near, false), whole.near),
          std::min(rounded(1.0001f * window.far, true), whole.far)};
}

}  // namespace limn::shadow
