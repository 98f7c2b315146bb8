// Front and back of the specular objects as some views see them (thesis, section 8.3.2): where the images of
// light and of the scene in them are found. A view is that of a light, or of the camera.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/scene/gpu_scene.h"
#include "glsl/shadow_view.glsl"

namespace limn::caustics {

/// One layer per view.
struct SpecularBuffer {
  frame::TextureHandle
      surface;  ///< RGBA32F: shading normal; w: +-(instance + 1), negative where the back shows
  frame::TextureHandle depth;            ///< R32F: linear depth (shadow_normalise), 1 where there is nothing
  frame::TextureHandle geometricNormal;  ///< RG16_SNORM: octahedral, of the triangle's front face
};

class LIMN_API SpecularBuffers {
 public:
  explicit SpecularBuffers(scene::GpuScene& scene) : scene_(scene) {}

  /// The views that the passes draw from now on, as many as when they were declared.
  void setViews(std::span<const glsl::ShadowView> views);
  /// Declares the passes "specular front" (nearest surfaces) and "specular back" (farthest ones of the
  /// instances that the front shows) on behalf of `owner`. `views`: storage buffer of the views; `size`:
  /// texels per side. Must outlive the graph.
  void add(frame::FrameGraph& graph, const SceneHandles& handles, frame::BufferHandle views, int size,
           const char* owner);

  const SpecularBuffer& front() const { return front_; }
  const SpecularBuffer& back() const { return back_; }

 private:
  SpecularBuffer addPass(frame::FrameGraph& graph, const SceneHandles& handles, frame::BufferHandle views,
                         int size, const char* owner, const SpecularBuffer* front);

  scene::GpuScene& scene_;
  std::vector<scene::DepthView> depthViews_;
  SpecularBuffer front_, back_;
  scene::DrawList frontList_, backList_;
};

}  // namespace limn::caustics
