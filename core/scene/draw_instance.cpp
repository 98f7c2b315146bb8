#include "core/scene/draw_instance.h"

#include <cstddef>

#include "core/scene/normal_matrix.h"

namespace limn::scene {
namespace {

const Primitive& ofMesh(const Scene& scene, const DrawInstance& instance) {
  return scene.meshes[static_cast<std::size_t>(instance.mesh)]
      .primitives[static_cast<std::size_t>(instance.primitive)];
}

}  // namespace

const Primitive& primitiveOf(const Scene& scene, const Pose& pose, const DrawInstance& instance) {
  if (instance.node == kNone) return *pose.dynamic[static_cast<std::size_t>(instance.mesh)].primitive;
  return ofMesh(scene, instance);
}

int materialIndexOf(const Scene& scene, const DrawInstance& instance) {
  if (instance.node == kNone) return scene.dynamic[static_cast<std::size_t>(instance.mesh)].material;
  return ofMesh(scene, instance).material;
}

const Material& materialOf(const Scene& scene, const DrawInstance& instance) {
  return scene.materials[static_cast<std::size_t>(materialIndexOf(scene, instance))];
}

bool mirrored(const DrawInstance& instance) {
  return mirrors(instance.objectToWorld) != instance.mirroredSkin;
}

}  // namespace limn::scene
