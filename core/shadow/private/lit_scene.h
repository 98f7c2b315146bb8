// Declares what shadow maps are fitted to: the lights, the bounds of what they shine on, and what the camera
// sees of it. Internal to ShadowMapService.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/scene.h"
#include "core/shadow/visible_scene.h"
#include "glsl/scene/light.glsl"

namespace limn::shadow {

/// Holds the lights and bounds of the pose that was taken last.
class LitScene {
 public:
  explicit LitScene(scene::GpuScene& scene);

  /// Takes the lights and bounds of `pose`. Returns true if they changed.
  bool take(const scene::Pose& pose);
  /// Finds what the camera sees of `pose`, which the bounds belong to. Returns true if it changed.
  bool see(const scene::Pose& pose);

  size_t lightCount() const { return lights_.size(); }
  /// Returns a light. Throws UsageError where the scene has none of this number.
  const glsl::Light& light(uint32_t index) const;
  const std::string& lightName(uint32_t index) const { return lightNames_[index]; }
  /// Returns the bounds of what may be in the light's maps: everything except its own quad. `kept` holds them
  /// where it has one.
  std::span<const scene::Bounds> boxesFor(const glsl::Light& light, std::vector<scene::Bounds>& kept) const;
  /// Returns null until see() is called.
  const VisibleScene* visible() const { return visible_.get(); }

 private:
  scene::GpuScene& scene_;
  std::vector<glsl::Light> lights_;
  std::vector<std::string> lightNames_;
  std::vector<scene::Bounds> boxes_;
  std::unique_ptr<VisibleScene> visible_;
};

}  // namespace limn::shadow
