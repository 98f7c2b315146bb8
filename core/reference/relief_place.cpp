#include "core/reference/private/relief_place.h"

#include <algorithm>
#include <cmath>

#include "core/relief/interreflection.h"

namespace limn::reference {
namespace {

/// Counts the sizes of a map that a place may lie off it: more than relief::traceRay follows a ray.
constexpr double kFarthestSizes = 128;

/// Returns the place of a texture coordinate, moved towards the map where rays meet the same there.
glm::dvec2 placeNearMap(const relief::HeightField& field, const glm::dvec2& uv) {
  if (field.wrap() == relief::Wrap::periodic) return field.place(uv - glm::floor(uv));
  const double farthest = kFarthestSizes * std::max(field.size().x, field.size().y);
  return glm::clamp(field.place(uv), -farthest, farthest);
}

}  // namespace

std::optional<glm::dvec2> ReliefPlace::bumpAlong(const glm::vec3& direction) const {
  if (!field) return std::nullopt;
  return relief::traceRay(*field, place, glm::dvec3(glsl::to_local(frame, direction)));
}

glm::vec4 ReliefPlace::tangent() const {
  return {frame.t, glm::dot(glm::cross(frame.n, frame.t), frame.b) < 0.f ? 1.f : -1.f};
}

glm::vec2 ReliefPlace::uv() const {
  return glm::vec2((place + 0.5) / glm::dvec2(field->size()));
}

ReliefPlace reliefPlace(const relief::HeightField& field, const glm::vec2& uv, const glm::vec3& normal,
                        const glm::vec4& tangent) {
  const float size = glm::length(normal);
  if (!(size > 0.f) || !std::isfinite(uv.x) || !std::isfinite(uv.y)) return {};
  const glm::vec3 n = normal / size;
  const glm::vec3 along = glm::vec3(tangent) - n * glm::dot(n, glm::vec3(tangent));
  const float length = glm::length(along);
  if (!(length > 0.f)) return {};
  const glm::vec3 t = along / length;
  // The bitangent points up the texture, against v (scene::generateTangents).
  const glm::vec3 b = tangent.w < 0.f ? glm::cross(n, t) : -glm::cross(n, t);
  return {.field = &field, .place = placeNearMap(field, uv), .frame = {.t = t, .b = b, .n = n}};
}

}  // namespace limn::reference
