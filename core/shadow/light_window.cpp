#include "core/shadow/private/light_window.h"

#include <algorithm>
#include <cmath>

#include "core/shadow/light_fit.h"
#include "glsl/light/light_part.glsl"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/numeric/geometry.glsl"

namespace limn::shadow {

using glm::vec3;
using scene::Bounds;

namespace {

float outerHalfAngle(const glsl::Light& light) {
  return std::acos(std::clamp(light.cos_outer, -1.f, 1.f));
}

/// Of a light with hasCone(): half the width of its map at unit distance.
float coneTangent(const glsl::Light& light, int size) {
  return std::tan(outerHalfAngle(light)) * widening(size);
}

}  // namespace

MapAxes axesOf(const glsl::Light& light) {
  const vec3 z(light.direction), u(light.axis_u), v(light.axis_v);
  if (glsl::light_is_distant_rectangle(light)) {
    const vec3 x = glm::normalize(u - glm::dot(u, z) * z);
    return {x, glm::cross(x, z), z};
  }
  const vec3 other = glm::cross(u, v);
  if (glm::dot(u, u) > 0.5f && glm::dot(v, v) > 0.5f && glm::dot(other, z) < -0.5f) return {u, v, z};
  const glsl::Frame frame = glsl::frame_around(-z);
  return {frame.t, frame.b, z};
}

vec3 spreadOf(const glsl::Light& light, const MapAxes& axes, float size) {
  if (light.type == glsl::light_directional && !glsl::light_is_distant_rectangle(light))
    return vec3(glm::vec2(std::tan(std::min(0.5f * (size < 0 ? light.angular_diameter : size), 1.55f))), 0);
  // A square that faces the receiver, whichever way.
  if (light.type == glsl::light_point || light.type == glsl::light_spot)
    return vec3(std::sqrt(0.5f) * std::max(size, 0.f));
  vec3 u = light.length_u * light.axis_u, v = light.length_v * light.axis_v;
  const bool distant = glsl::light_is_distant_rectangle(light);
  if (size >= 0) {
    const float side = distant ? 2 * std::tan(std::min(0.5f * size, 1.5f)) : size;
    u = side * light.axis_u;
    v = side * light.axis_v;
  }
  const auto reach = [&](const vec3& axis) {
    return 0.5f * (std::abs(glm::dot(axis, u)) + std::abs(glm::dot(axis, v)));
  };
  const vec3 half(reach(axes.x), reach(axes.y), reach(axes.z));
  if (!distant) return half;
  // Points are directions centre + a u + b v: across the map's axis per metre along it.
  const float along = std::max(glm::length(light.position) - half.z, 1e-3f);
  return {half.x / along, half.y / along, 0};
}

vec3 samplePoint(const glsl::Light& light, const glm::vec2& sample) {
  return glsl::rectangle_point(light, sample - 0.5f);
}

bool hasCone(const glsl::Light& light) {
  return (light.flags & glsl::light_flag_cone) != 0 && outerHalfAngle(light) <= kLargestHalfAngle;
}

float widening(int size) {
  return 1 + std::min(4 / static_cast<float>(size), 0.25f);
}

MapWindow squareWindow(float half, const DepthRange& range) {
  return {glm::vec2(-half), glm::vec2(half), range.near, range.far};
}

MapWindow wholeWindow(const glsl::Light& light, const vec3& origin, const MapAxes& axes,
                      const LightLayout& layout, std::span<const Bounds> boxes, const ShadowMapDesc& desc) {
  const uint32_t count = glsl::shadow_face_count(layout.faces);
  float tangent = 1;
  if (count <= 2) {
    tangent =
        light.type == glsl::light_spot ? coneTangent(light, desc.size) : fittedTangent(origin, axes, boxes);
    if (count == 2) tangent = std::max(tangent, fittedTangent(origin, faceAxes(axes, 5), boxes));
    if (light.type != glsl::light_spot) tangent *= widening(desc.size);
    // The cone is that of the light's centre: a sample aside of it sees what lies in it at a wider angle.
    if (hasCone(light) && count == 1 && desc.samples.empty())
      tangent = std::min(tangent, coneTangent(light, desc.size));
    if (!(tangent > 0)) tangent = 1;
  }
  const uint32_t step = layout.faces == glsl::shadow_faces_pair ? 5 : 1;
  return squareWindow(tangent, widened(pyramidRange(origin, axes, count, step, tangent, boxes)));
}

std::span<const Bounds> withinRange(const glsl::Light& light, std::span<const Bounds> boxes,
                                    const ShadowMapDesc& desc, std::vector<Bounds>& kept) {
  if (desc.fit != MapFit::view || light.type == glsl::light_directional || !(light.range > 0)) return boxes;
  const glm::vec2 sides = glsl::light_sides(light, glsl::light_kind(light), desc.lightSize);
  return boxesAround(light.position, 1.001f * std::max(light.range, 0.5f * glm::length(sides)), boxes, kept);
}

}  // namespace limn::shadow
