// A cloud of triangles over a floor, and maps that are fitted to what a camera sees of it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "core/shadow/light_fit.h"
#include "tests/support/test_scenes.h"

namespace limn::test {

/// A floor and a cloud of triangles over it, some of them near the light.
struct Cloud {
  scene::Scene scene;
  scene::Pose pose;
  std::vector<scene::Bounds> boxes;
  std::vector<std::array<glm::vec3, 3>> triangles;

  explicit Cloud(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    addMesh(scene, floorPrimitive(6, addMaterial(scene)));
    scene::Primitive soup;
    for (uint32_t i = 0; i < 240; ++i) {
      const glm::vec3 middle(4 * uniform(random), 1.6f + 1.5f * uniform(random), 4 * uniform(random));
      for (uint32_t k = 0; k < 3; ++k) {
        soup.positions.push_back(middle +
                                 0.15f * glm::vec3(uniform(random), uniform(random), uniform(random)));
        soup.indices.push_back(3 * i + k);
      }
    }
    soup.normals.assign(soup.positions.size(), {0, 1, 0});
    addMesh(scene, finish(soup));
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 1;
    addInstance(scene, pose, 0);
    addInstance(scene, pose, 1, glm::rotate(glm::mat4(1), 0.3f, {0, 1, 0}));
    for (const scene::DrawInstance& drawn : pose.instances) {
      scene::Bounds box;
      const scene::Primitive& p = scene.meshes[static_cast<size_t>(drawn.mesh)].primitives[0];
      for (size_t i = 0; i < p.indices.size(); i += 3) {
        std::array<glm::vec3, 3> triangle;
        for (size_t k = 0; k < 3; ++k) {
          triangle[k] = glm::vec3(drawn.objectToWorld * glm::vec4(p.positions[p.indices[i + k]], 1));
          box.add(triangle[k]);
        }
        triangles.push_back(triangle);
      }
      boxes.push_back(box);
    }
  }
};

/// Where the segment from a to b meets a triangle.
inline std::optional<glm::vec3> hit(const std::array<glm::vec3, 3>& t, const glm::vec3& a,
                                    const glm::vec3& b) {
  const glm::vec3 u = t[1] - t[0], v = t[2] - t[0], d = b - a, p = glm::cross(d, v);
  const float determinant = glm::dot(u, p);
  if (std::abs(determinant) < 1e-12f) return {};
  const glm::vec3 s = a - t[0], q = glm::cross(s, u);
  const float x = glm::dot(s, p) / determinant, y = glm::dot(d, q) / determinant,
              along = glm::dot(v, q) / determinant;
  if (x < 0 || y < 0 || x + y > 1 || along < 0 || along > 1) return {};
  return a + along * d;
}

inline bool seenBy(const scene::CameraPose& camera, float aspect, const glm::vec3& p) {
  const glm::vec3 v(camera.worldToView * glm::vec4(p, 1));
  const float up = std::tan(0.5f * camera.yfov);
  return v.z < 0 && std::abs(v.y) < -up * v.z && std::abs(v.x) < -up * aspect * v.z;
}

struct Fitted {
  std::vector<glsl::ShadowView> views;
  std::vector<glsl::ShadowLight> lights;
};

inline Fitted fit(const Cloud& cloud, const glsl::Light& light, const shadow::ShadowMapDesc& desc,
                  const shadow::VisibleScene* visible) {
  Fitted f;
  shadow::appendViews(light, 0, shadow::fitLayout(light, cloud.boxes, desc), cloud.boxes, desc, visible,
                      f.views, f.lights);
  return f;
}

inline float sideOf(const glsl::ShadowView& view) {
  return 1 / view.scale;
}

inline Cloud scaledBy(const Cloud& cloud, float scale) {
  Cloud scaled = cloud;
  for (scene::DrawInstance& drawn : scaled.pose.instances)
    drawn.objectToWorld = glm::scale(glm::mat4(1), glm::vec3(scale)) * drawn.objectToWorld;
  for (scene::Bounds& box : scaled.boxes) box = {scale * box.low, scale * box.high};
  return scaled;
}

/// A half cube, a cube of a point light, and one of a rectangle that shines both ways.
inline glsl::Light lightOfFaces(int kind) {
  glsl::Light light = rectangleLight({-0.4f, 3.6f, 0.3f}, {0.05f, -1, 0.03f}, 0.8f, 0.5f);
  if (kind == 1) light = pointLight({-0.4f, 3.6f, 0.3f});
  if (kind == 2) light.flags |= glsl::light_flag_two_sided;
  return light;
}

}  // namespace limn::test
