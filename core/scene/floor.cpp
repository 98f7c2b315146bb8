#include "core/scene/floor.h"

#include <cmath>
#include <utility>

#include "core/scene/framing.h"

namespace limn::scene {
namespace {

constexpr float kHalfSide = 3.5f;  // radii of the bounds: as far as shadows of a low sun reach
constexpr float kBelow = 1e-4f;    // radii: what stands on it does not lie in its plane
constexpr float kReflectance = 0.5f;

}  // namespace

void addFloor(Scene& scene, const Bounds& bounds) {
  if (bounds.empty()) return;
  Material material;
  material.name = "floor";
  material.baseColour = {kReflectance, kReflectance, kReflectance, 1};
  material.metallic = 0;
  material.specularFactor = 0;
  material.doubleSided = true;

  const float half = kHalfSide * bounds.radius();
  Primitive square;
  square.positions = {{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
  square.normals.assign(4, {0, 1, 0});
  square.indices = {0, 1, 2, 0, 2, 3};
  square.bounds = {{-half, 0, -half}, {half, 0, half}};
  square.material = static_cast<int>(scene.materials.size());

  Node node;
  node.name = "floor";
  node.transform.translation = {bounds.centre().x, bounds.low.y - kBelow * bounds.radius(),
                                bounds.centre().z};
  // For the camera of scenes without one its far side is level.
  node.transform.rotation = glm::angleAxis(std::atan2(kSeenFrom.x, kSeenFrom.z), glm::vec3(0, 1, 0));
  node.base = scene.origin;
  node.mesh = static_cast<int>(scene.meshes.size());

  scene.materials.push_back(std::move(material));
  scene.meshes.push_back({.name = "floor", .primitives = {std::move(square)}, .morphWeights = {}});
  scene.nodes.push_back(std::move(node));
}

}  // namespace limn::scene
