#include "core/scene/private/world_light.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/scene/normal_matrix.h"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/numeric/equirectangular.glsl"

namespace limn::scene {
namespace {

/// Right-handed axes of a node without its scale; z is kept, x made perpendicular to it. Where the node
/// mirrors, y stays up and x turns round: else cameras below it would stand on their heads. An axis without
/// length is perpendicular to the other two.
glm::mat3 axes(const glm::mat4& m) {
  const auto unit = [](const glm::dvec3& v, const glm::dvec3& fallback) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : fallback;
  };
  const glm::dvec3 right(m[0]), up(m[1]);
  const glm::dvec3 z = unit(glm::dvec3(m[2]), unit(glm::cross(right, up), glm::dvec3(0, 0, 1)));
  const glm::dvec3 other = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 any = unit(other - glm::dot(other, z) * z, other);
  glm::dvec3 x = unit(right, unit(glm::cross(up, z), any));
  x = unit(x - glm::dot(x, z) * z, any);
  if (mirrors(m)) x = -x;
  return glm::mat3(glm::vec3(x), glm::vec3(glm::cross(z, x)), glm::vec3(z));
}

}  // namespace

glsl::Light punctualLight(const LightSource& source, const glm::vec2& area, const glm::mat4& nodeToWorld) {
  const glm::mat3 axis = axes(nodeToWorld);
  const bool rectangle = area.x > 0 && area.y > 0 && source.type != glsl::light_directional;
  glsl::Light light{};
  light.position = glm::vec3(nodeToWorld[3]);
  light.direction = -axis[2];
  light.texture_number = static_cast<float>(source.texture + 1);
  light.axis_u = axis[0];
  light.length_u = rectangle ? area.x : 0.f;
  light.axis_v = axis[1];
  light.length_v = rectangle ? area.y : 0.f;
  const float scale = rectangle ? source.intensity / (area.x * area.y) : source.intensity;
  light.emission = source.colour * scale;
  const bool cone = source.type == glsl::light_spot;
  light.cos_inner = cone ? std::cos(source.innerCone) : -1.f;
  light.cos_outer = cone ? std::cos(source.outerCone) : -1.f;
  light.range = source.range;
  light.angular_diameter = source.angle;
  light.type = rectangle ? glsl::light_rectangle : source.type;
  light.flags = cone ? glsl::light_flag_cone : 0u;
  light.own_instance = glsl::no_instance;
  return light;
}

std::optional<glsl::Light> quadLight(const EmissivePart& part, const Material& material,
                                     const glm::mat4& objectToWorld, uint32_t instance) {
  const Quad& quad = part.quad;
  const glm::dmat3 m(objectToWorld);
  glm::dvec3 u = m * glm::dvec3(quad.sideU), v = m * glm::dvec3(quad.sideV);
  double lengthU = glm::length(u), lengthV = glm::length(v);
  const bool area = lengthU > 0 && lengthV > 0;
  glm::dvec3 front;
  if (area) {
    if (std::abs(glm::dot(u, v)) > 1e-3 * lengthU * lengthV) return std::nullopt;
    u /= lengthU;
    v /= lengthV;
    // A mirroring transform turns the winding around and the front face with it (glTF 2.0, section 3.7.4).
    front = (glm::determinant(m) < 0 ? -1.0 : 1.0) * glm::normalize(glm::cross(u, v));
    v = glm::cross(-front, u);  // removes the last 1e-3 of skew, and cross(u, v) = -front
  } else {
    const glm::dmat3 axis(axes(objectToWorld));
    lengthU = lengthV = 0;
    u = axis[0];
    v = axis[1];
    front = -axis[2];
  }
  glsl::Light light{};
  light.position = glm::vec3(objectToWorld * glm::vec4(quad.centre, 1));
  light.direction = glm::vec3(front);
  light.axis_u = glm::vec3(u);
  light.length_u = static_cast<float>(lengthU);
  light.axis_v = glm::vec3(v);
  light.length_v = static_cast<float>(lengthV);
  light.emission = area ? material.emission * part.texture : glm::vec3(0);
  light.cos_inner = -1;
  light.cos_outer = -1;
  const uint32_t sides = material.doubleSided ? glsl::light_flag_two_sided : 0u;
  light.type = glsl::light_rectangle;
  light.flags = glsl::light_flag_geometry | sides;
  light.own_instance = instance;
  return light;
}

glsl::Light distantLight(const DistantRectangle& rectangle, const Environment& environment) {
  const auto turned = [&](const glm::vec3& d) {
    return glsl::environment_world_direction(d, environment.rotation);
  };
  glsl::Light light{};
  const glm::vec3 centre = turned(rectangle.centre);
  light.position = centre;
  light.direction = -glm::normalize(centre);
  light.axis_u = turned(rectangle.axisU);
  light.length_u = rectangle.sides.x;
  light.axis_v = turned(rectangle.axisV);
  light.length_v = rectangle.sides.y;
  light.cos_inner = -1;
  light.cos_outer = -1;
  light.type = glsl::light_directional;
  light.flags = glsl::light_flag_environment | (environment.reflectCentres ? glsl::light_flag_centre : 0u);
  light.own_instance = glsl::no_instance;
  const glsl::Rectangle seen = glsl::rectangle_from(light, glm::vec3(0));
  light.emission = rectangle.irradiance * environment.scale;
  light.solid_angle = glsl::rectangle_solid_angle(seen, glsl::rectangle_whole());
  return light;
}

glm::mat4 worldToView(const glm::mat4& nodeToWorld) {
  const glm::mat3 inverse = glm::transpose(axes(nodeToWorld));
  glm::mat4 view(inverse);
  view[3] = glm::vec4(-(inverse * glm::vec3(nodeToWorld[3])), 1);
  return view;
}

void setName(std::string& out, const std::string& first, const std::string& second, int index) {
  if (!first.empty()) {
    out = first;
  } else if (!second.empty()) {
    out = second;
  } else {
    out.clear();
    fmt::format_to(std::back_inserter(out), "#{}", index);
  }
}

}  // namespace limn::scene
