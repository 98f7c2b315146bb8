// Small scenes made in memory, with poses, for tests of what draws them.
#pragma once

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/scene.h"

namespace limn::test {

inline scene::Primitive finish(scene::Primitive p) {
  for (const glm::vec3& v : p.positions) p.bounds.add(v);
  return p;
}

/// A rectangle in the plane y = 0 around the origin, facing +y, sides 2 `half`; uv from 0 to 1.
inline scene::Primitive floorPrimitive(float half, int material) {
  scene::Primitive p;
  p.positions = {{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
  p.normals.assign(4, {0, 1, 0});
  p.tangents.assign(4, {1, 0, 0, 1});
  p.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3};
  p.material = material;
  return finish(p);
}

/// A latitude-longitude sphere.
inline scene::Primitive spherePrimitive(float radius, int material, int rings = 48) {
  scene::Primitive p;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const float theta = glsl::pi * static_cast<float>(i) / static_cast<float>(rings);
      const float phi = 2 * glsl::pi * static_cast<float>(j) / static_cast<float>(columns);
      const glm::vec3 n(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
      p.positions.push_back(radius * n);
      p.normals.push_back(n);
      p.uvs.emplace_back(static_cast<float>(j) / static_cast<float>(columns),
                         static_cast<float>(i) / static_cast<float>(rings));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * (columns + 1) + j); };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i > 0) p.indices.insert(p.indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rings) p.indices.insert(p.indices.end(), {at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  p.material = material;
  return finish(p);
}

/// Triangles of a source, which never change.
class StillSource : public scene::GeometrySource {
 public:
  explicit StillSource(scene::Primitive primitive)
      : primitive_(std::make_shared<const scene::Primitive>(std::move(primitive))) {}
  std::shared_ptr<const scene::Primitive> at(double) override { return primitive_; }

 private:
  std::shared_ptr<const scene::Primitive> primitive_;
};

inline int addMaterial(scene::Scene& scene, const scene::Material& material = {}) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

inline int addMesh(scene::Scene& scene, scene::Primitive primitive) {
  scene::Mesh mesh;
  mesh.primitives.push_back(std::move(primitive));
  scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene.meshes.size()) - 1;
}

/// Draws one primitive of a mesh; returns its instance id.
inline uint32_t addInstance(const scene::Scene& scene, scene::Pose& pose, int mesh,
                            const glm::mat4& objectToWorld = glm::mat4(1)) {
  scene::DrawInstance instance;
  instance.node = 0;
  instance.mesh = mesh;
  instance.objectToWorld = objectToWorld;
  pose.instances.push_back(instance);
  for (const glm::vec3& p : scene.meshes[static_cast<size_t>(mesh)].primitives[0].positions)
    pose.bounds.add(glm::vec3(objectToWorld * glm::vec4(p, 1)));
  return static_cast<uint32_t>(pose.instances.size()) - 1;
}

inline glm::mat4 at(float x, float y, float z, float scale = 1) {
  return glm::scale(glm::translate(glm::mat4(1), {x, y, z}), glm::vec3(scale));
}

inline uint32_t addLight(scene::Pose& pose, glsl::Light light) {
  light.index = static_cast<uint32_t>(pose.lights.size());
  pose.lights.push_back(light);
  pose.lightNames.push_back("light" + std::to_string(light.index));
  return light.index;
}

/// A light frame that looks along `direction`, as the scene loader makes them.
inline glsl::Light orientedLight(uint32_t type, glm::vec3 position, glm::vec3 direction) {
  direction = glm::normalize(direction);
  const glm::vec3 other = std::abs(direction.y) > 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 u = glm::normalize(glm::cross(direction, other));
  const glm::vec3 v = glm::cross(u, direction);
  glsl::Light light{};
  light.position = position;
  light.direction = direction;
  light.axis_u = u;
  light.axis_v = v;
  light.emission = glm::vec3(1);
  light.solid_angle = 1;
  light.type = type;
  light.own_instance = glsl::no_instance;
  return light;
}

inline glsl::Light pointLight(glm::vec3 position) {
  return orientedLight(glsl::light_point, position, {0, -1, 0});
}
inline glsl::Light spotLight(glm::vec3 position, glm::vec3 direction, float halfAngle) {
  glsl::Light light = orientedLight(glsl::light_spot, position, direction);
  light.cos_inner = std::cos(0.9f * halfAngle);
  light.cos_outer = std::cos(halfAngle);
  light.range = 0;
  light.angular_diameter = 0;
  light.flags = glsl::light_flag_cone;
  return light;
}
inline glsl::Light directionalLight(glm::vec3 direction, float angle) {
  glsl::Light light = orientedLight(glsl::light_directional, glm::vec3(0), direction);
  light.angular_diameter = angle;
  return light;
}
inline glsl::Light rectangleLight(glm::vec3 position, glm::vec3 direction, float u, float v,
                                  bool twoSided = false) {
  glsl::Light light = orientedLight(glsl::light_rectangle, position, direction);
  light.length_u = u;
  light.length_v = v;
  light.flags = twoSided ? glsl::light_flag_two_sided : 0u;
  return light;
}

}  // namespace limn::test
