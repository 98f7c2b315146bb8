// Small scenes with nodes, made in memory: what can be asked of both renderers.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "tests/support/test_scenes.h"

namespace limn::test {

/// Rectangle centre +- u/2 +- v/2, front face along cross(u, v). A texture stands upright on it: its u grows
/// along u, its v against v.
inline scene::Primitive quad(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v, int material) {
  scene::Primitive p;
  p.positions = {centre - 0.5f * u - 0.5f * v, centre + 0.5f * u - 0.5f * v, centre + 0.5f * u + 0.5f * v,
                 centre - 0.5f * u + 0.5f * v};
  p.normals.assign(4, glm::normalize(glm::cross(u, v)));
  p.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3};
  p.material = material;
  return p;
}

/// The primitive with the triangles of both; they have the same material and attributes.
inline scene::Primitive joined(scene::Primitive whole, const scene::Primitive& part) {
  const auto first = static_cast<uint32_t>(whole.positions.size());
  whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
  whole.normals.insert(whole.normals.end(), part.normals.begin(), part.normals.end());
  whole.uvs.insert(whole.uvs.end(), part.uvs.begin(), part.uvs.end());
  for (const uint32_t index : part.indices) whole.indices.push_back(first + index);
  return whole;
}

/// A node that draws the primitive.
inline void show(scene::Scene& scene, scene::Primitive primitive, const glm::mat4& place = glm::mat4(1)) {
  scene::Node node;
  node.mesh = addMesh(scene, finish(std::move(primitive)));
  node.matrix = place;
  scene.nodes.push_back(node);
}

/// A node with a light that shines along `direction`.
inline void shine(scene::Scene& scene, const scene::LightSource& source, const glm::vec3& position,
                  const glm::vec3& direction = {0, -1, 0}) {
  const glm::vec3 d = glm::normalize(direction);
  scene::Node node;
  node.light = static_cast<int>(scene.lights.size());
  node.transform.translation = position;
  node.transform.rotation =
      glm::quatLookAt(d, std::abs(d.y) > 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0));
  scene.nodes.push_back(node);
  scene.lights.push_back(source);
}
inline scene::LightSource lamp(uint32_t type, float intensity) {
  scene::LightSource source;
  source.type = type;
  source.intensity = intensity;
  return source;
}

inline scene::Material lambertian(float albedo) {
  scene::Material m;
  m.baseColour = glm::vec4(albedo, albedo, albedo, 1);
  m.metallic = 0;
  m.roughness = 1;
  m.specularFactor = 0;
  return m;
}
inline scene::Material silver() {
  scene::Material m;
  m.metallic = 1;
  m.roughness = 0;
  return m;
}
inline scene::Material glass(float ior) {
  scene::Material m;
  m.metallic = m.roughness = 0;
  m.transmission = m.thickness = 1;
  m.ior = ior;
  return m;
}

/// Where the rays of a picture start and go.
class ViewRays {
 public:
  ViewRays(const scene::CameraPose& camera, const scene::Bounds& bounds, glm::ivec2 size)
      : height_(size.y), frame_{} {
    scene::setCamera(frame_, camera, bounds, size.x, size.y);
  }
  glm::dvec3 eye() const { return glm::dvec3(glm::vec3(frame_.camera_position)); }
  /// Through the centre of a pixel, rows from the top; 1 m deep.
  glm::dvec3 ray(int x, int y) const {
    return glm::dvec3(glm::vec3(frame_.view_ray_origin) +
                      static_cast<float>(x) * glm::vec3(frame_.view_ray_dx) +
                      static_cast<float>(height_ - 1 - y) * glm::vec3(frame_.view_ray_dy));
  }
  glm::dvec3 direction(int x, int y) const { return glm::normalize(ray(x, y)); }

 private:
  int height_;
  glsl::FrameBlock frame_;
};

}  // namespace limn::test
