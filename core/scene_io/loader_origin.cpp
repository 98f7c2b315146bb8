// Scenes far from the file's origin: where their positions are counted from.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

/// Scenes whose middle lies further away, in their own radii, lose more than 18 of a float's 24 bits to where
/// they are, or nearly so; those that lie nearer stay as they are.
constexpr float kFarRadii = 64;

bool isFar(const Bounds& bounds) {
  if (bounds.empty()) return false;
  const glm::vec3 centre = glm::abs(bounds.centre());
  return std::max({centre.x, centre.y, centre.z}) > kFarRadii * bounds.radius();
}

/// `place` on the lattice of a power of two about as wide as the scene, so that what lies on round
/// coordinates still does.
glm::dvec3 onLattice(const glm::dvec3& place, float radius) {
  if (!(radius > 0)) return place;
  const double step = std::exp2(std::ceil(std::log2(static_cast<double>(radius))));
  return glm::round(place / step) * step;
}

/// What the file says, before it is rounded to float.
glm::dvec3 translationOf(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return {node.matrix[12], node.matrix[13], node.matrix[14]};
  if (node.translation.size() == 3) return {node.translation[0], node.translation[1], node.translation[2]};
  return glm::dvec3(0);
}

/// Keys that are counted from the node's base.
void rebase(AnimationChannel& channel, const glm::dvec3& base) {
  const bool cubic = channel.interpolation == AnimationChannel::Interpolation::cubic;
  for (std::size_t key = 0; key < channel.times.size(); ++key) {
    float* value = &channel.values[3 * (cubic ? 3 * key + 1 : key)];
    for (int c = 0; c < 3; ++c) value[c] = static_cast<float>(value[c] - base[c]);
  }
}

}  // namespace

void Loader::rebaseNodes() {
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    Node& node = scene_.nodes[i];
    node.base = translationOf(model_->nodes[static_cast<std::size_t>(fileIndex_[i])]);
    node.transform.translation = glm::vec3(0);
    if (node.matrix) (*node.matrix)[3] = glm::vec4(0, 0, 0, 1);
  }
  for (Animation& animation : scene_.animations)
    for (AnimationChannel& channel : animation.channels)
      if (channel.path == AnimationChannel::Path::translation)
        rebase(channel, scene_.nodes[static_cast<std::size_t>(channel.node)].base);
}

void Loader::moveOrigin() {
  Bounds bounds = poseAtRest().bounds;
  if (!isFar(bounds)) return;
  scene_.origin = bounds.centre();
  rebaseNodes();
  readMetaballs();
  bounds = poseAtRest().bounds;  // now without the rounding that large coordinates bring
  scene_.origin = onLattice(scene_.origin + glm::dvec3(bounds.centre()), bounds.radius());
  readMetaballs();
}

}  // namespace limn::scene
