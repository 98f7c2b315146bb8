#include "core/scene/default_lights.h"

#include <algorithm>

namespace limn::scene {
namespace {

constexpr float kKeyRadiance = 0.7f, kHeadlightRadiance = 0.15f;  // of a white Lambertian surface

void addLight(Scene& scene, LightSource source, const Transform& transform) {
  Node node;
  node.name = source.name;
  node.transform = transform;
  node.base = scene.origin;
  node.light = static_cast<int>(scene.lights.size());
  scene.lights.push_back(std::move(source));
  scene.nodes.push_back(std::move(node));
}

}  // namespace

void addDefaultLights(Scene& scene, const CameraPose& camera, const Bounds& bounds) {
  if (bounds.empty()) return;
  const glm::mat4 viewToWorld = glm::inverse(camera.worldToView);
  const glm::vec3 eye(viewToWorld[3]);
  const glm::vec3 shines = glm::normalize(glm::mat3(viewToWorld) * glm::vec3(0.5f, -0.75f, -0.7f));

  LightSource key;
  key.name = "key";
  key.type = glsl::light_directional;
  key.intensity = kKeyRadiance * glsl::pi;
  key.angle = 0.03f;
  addLight(scene, key, {.rotation = glm::quatLookAt(shines, glm::vec3(viewToWorld[1]))});

  LightSource headlight;
  headlight.name = "headlight";
  headlight.type = glsl::light_point;
  // Inside a scene its centre may be anywhere, the camera's place included.
  const float distance = std::max(glm::length(eye - bounds.centre()), 0.5f * bounds.radius());
  headlight.intensity = kHeadlightRadiance * glsl::pi * distance * distance;
  addLight(scene, headlight, {.translation = eye});
}

}  // namespace limn::scene
