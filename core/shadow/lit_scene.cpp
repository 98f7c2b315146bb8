#include "core/shadow/private/lit_scene.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/same_bytes.h"

namespace limn::shadow {

LitScene::LitScene(scene::GpuScene& scene) : scene_(scene) {}

bool LitScene::take(const scene::Pose& pose) {
  bool changed = !sameBytes(lights_, pose.lights) || lightNames_ != pose.lightNames ||
                 boxes_.size() != scene_.instanceCount();
  if (changed) {
    lights_ = pose.lights;
    lightNames_ = pose.lightNames;
    boxes_.resize(scene_.instanceCount());
  }
  for (uint32_t i = 0; i < boxes_.size(); ++i) {
    if (boxes_[i] == scene_.bounds(i)) continue;
    boxes_[i] = scene_.bounds(i);
    changed = true;
  }
  return changed;
}

bool LitScene::see(const scene::Pose& pose) {
  if (!visible_) visible_ = std::make_unique<VisibleScene>(scene_.scene());
  const glm::vec2 size(scene_.frame().frame_size);
  return visible_->update(pose, boxes_, scene_.camera(), size.x / size.y);
}

const glsl::Light& LitScene::light(uint32_t index) const {
  if (index >= lights_.size())
    throw UsageError(fmt::format("shadow map of light {}: the scene has {} lights", index, lights_.size()));
  return lights_[index];
}

std::span<const scene::Bounds> LitScene::boxesFor(const glsl::Light& light,
                                                  std::vector<scene::Bounds>& kept) const {
  if (light.own_instance >= boxes_.size()) return boxes_;
  kept = boxes_;
  kept[light.own_instance] = {};
  return kept;
}

}  // namespace limn::shadow
