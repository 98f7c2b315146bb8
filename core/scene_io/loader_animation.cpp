// Animations.
#include <tiny_gltf.h>

#include <algorithm>
#include <optional>

#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

std::optional<Path> pathOf(const std::string& name) {
  if (name == "translation") return Path::translation;
  if (name == "rotation") return Path::rotation;
  if (name == "scale") return Path::scale;
  if (name == "weights") return Path::weights;
  return std::nullopt;
}

std::optional<Interpolation> interpolationOf(const std::string& name) {
  if (name == "STEP") return Interpolation::step;
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "CUBICSPLINE") return Interpolation::cubic;
  return std::nullopt;
}

}  // namespace

void Loader::readAnimations() {
  for (std::size_t i = 0; i < model_->animations.size(); ++i) {
    const tinygltf::Animation& source = model_->animations[i];
    const std::string what = source.name.empty() ? fmt::format("animation {}", i)
                                                 : fmt::format("animation {} '{}'", i, source.name);
    Animation animation;
    animation.name = source.name;
    for (std::size_t k = 0; k < source.channels.size(); ++k) {
      const tinygltf::AnimationChannel& channel = source.channels[k];
      if (channel.target_node == kNone) continue;
      const std::string place = fmt::format("{} channel {}", what, k);
      if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= source.samplers.size())
        fail(fmt::format("{}: sampler {} does not exist; there are {}", place, channel.sampler,
                         source.samplers.size()));
      readChannel(channel, source.samplers[static_cast<std::size_t>(channel.sampler)], animation, place);
    }
    scene_.animations.push_back(std::move(animation));
  }
}

void Loader::readChannel(const tinygltf::AnimationChannel& source, const tinygltf::AnimationSampler& sampler,
                         Animation& animation, const std::string& what) {
  if (source.target_node < 0 || static_cast<std::size_t>(source.target_node) >= newIndex_.size())
    fail(fmt::format("{}: node {} does not exist; there are {}", what, source.target_node, newIndex_.size()));
  AnimationChannel channel{};
  channel.node = newIndex_[static_cast<std::size_t>(source.target_node)];
  const Node& node = scene_.nodes[static_cast<std::size_t>(channel.node)];
  const auto path = pathOf(source.target_path);
  if (!path) return warn(fmt::format("{}: target '{}' is ignored", what, source.target_path));
  const auto interpolation = interpolationOf(sampler.interpolation);
  if (!interpolation)
    fail(fmt::format("{}: interpolation '{}'; STEP, LINEAR or CUBICSPLINE is accepted", what,
                     sampler.interpolation));
  channel.path = *path;
  channel.interpolation = *interpolation;
  if (node.matrix && channel.path != Path::weights)
    return warn(what + ": its node has a matrix, which cannot be animated; ignored");

  channel.times = readFloats(sampler.input, {1}, -1, what + " input").values;
  if (channel.times.empty()) return;
  for (std::size_t i = 1; i < channel.times.size(); ++i) {
    if (!(channel.times[i] > channel.times[i - 1]))
      fail(fmt::format("{}: key times must increase; {} follows {}", what, channel.times[i],
                       channel.times[i - 1]));
  }
  std::size_t components = channel.path == Path::rotation ? 4 : 3;
  if (channel.path == Path::weights)
    components =
        node.mesh == kNone ? 0 : scene_.meshes[static_cast<std::size_t>(node.mesh)].morphWeights.size();
  if (components == 0) return;  // weights of a mesh without targets, or of a node outside the scene
  const std::size_t perKey = channel.interpolation == Interpolation::cubic ? 3 : 1;
  const std::size_t expected = channel.times.size() * components * perKey;
  channel.values =
      readFloats(
          sampler.output, {channel.path == Path::weights ? 1 : static_cast<int>(components)},
          static_cast<std::int64_t>(channel.path == Path::weights ? expected : channel.times.size() * perKey),
          what + " output")
          .values;
  animation.duration = std::max(animation.duration, channel.times.back());
  animation.channels.push_back(std::move(channel));
}

}  // namespace limn::scene
