#include "core/radiosity/disc_transport.h"

#include <array>
#include <cmath>

#include "glsl/numeric/geometry.glsl"

namespace limn::radiosity {
namespace {

constexpr size_t kCorners = 12;

/// The corners of a regular polygon of area 1.
const std::array<glm::vec2, kCorners>& corners() {
  static const std::array<glm::vec2, kCorners> unit = [] {
    std::array<glm::vec2, kCorners> result{};
    const double step = 2 * glsl::pi / double(kCorners);
    const double radius = std::sqrt(2 / (double(kCorners) * std::sin(step)));
    for (size_t i = 0; i < kCorners; ++i)
      result[i] = glm::vec2(radius * std::cos(step * double(i)), radius * std::sin(step * double(i)));
    return result;
  }();
  return unit;
}

}  // namespace

float discIrradiance(const glm::vec3& offset, const glm::vec3& normal, float area, const glm::vec3& up) {
  if (!(glm::dot(offset, normal) < 0)) return 0;
  const glsl::Frame frame = glsl::frame_around(normal);
  const float size = std::sqrt(area);
  std::array<glm::vec3, kCorners + 1> above;
  size_t count = 0;
  const auto corner = [&](size_t i) {
    const glm::vec2& c = corners()[i % kCorners];
    return offset + size * (c.x * frame.t + c.y * frame.b);
  };
  glm::vec3 here = corner(kCorners - 1);
  float heightHere = glm::dot(here, up);
  for (size_t i = 0; i < kCorners; ++i) {
    const glm::vec3 next = corner(i);
    const float heightNext = glm::dot(next, up);
    // A convex polygon meets a plane twice, but rounding may see more: what has no place is left out.
    const auto add = [&](const glm::vec3& p) {
      if (count < above.size()) above[count++] = p;
    };
    if ((heightHere >= 0) != (heightNext >= 0))
      add(here + heightHere / (heightHere - heightNext) * (next - here));
    if (heightNext >= 0) add(next);
    here = next;
    heightHere = heightNext;
  }
  if (count < 3) return 0;
  // Lambert 1760: half the sum over edges of the angle that the edge spans times the cosine of its plane.
  float sum = 0;
  glm::vec3 from = above[count - 1];
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 across = glm::cross(from, above[i]);
    const float sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(from, above[i])) / sine * glm::dot(across, up);
    from = above[i];
  }
  return 0.5f * std::abs(sum);
}

}  // namespace limn::radiosity
