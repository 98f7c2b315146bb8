// Declares buffers of the front and back of the specular objects as some views see them (thesis, section
// 8.3.2): the images of light and of the scene in these objects are searched for in them. A view is that of a
// light or of the camera.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/base/parameters.h"
#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_scene.h"
#include "glsl/shadow/shadow_view.glsl"

namespace limn::caustics {

/// Holds the textures of one side of the specular objects, with one layer per view.
struct SpecularBuffer {
  frame::TextureHandle
      surface;  ///< RGBA32F: shading normal; w: +-(instance + 1), negative where the back shows
  frame::TextureHandle depth;  ///< R32F: linear depth (shadow_normalise), 1 where there is nothing
  /// RG16_SNORM: octahedral, of the triangle's front face; empty where nobody asked for it.
  frame::TextureHandle geometricNormal;
};

/// Says which sides have geometric normals. Each fragment takes them from the corners of its triangle.
enum class GeometricNormals { none, front, both };

/// Returns the parameter that shaders with glsl/caustics/specular_buffers.glsl take as EXIT_STEPS. Software
/// renderers leave the loops of a thread after 65,535 steps, of which a path may make 15 such searches.
constexpr Parameter exitStepsParameter() {
  return integer("exit_steps", 32, {1, 1024}, "points",
                 "Of the search for the place where light inside an object leaves it")
      .logScale();
}

class LIMN_API SpecularBuffers {
 public:
  explicit SpecularBuffers(scene::GpuScene& scene) : scene_(scene) {}

  /// Sets the views that the passes draw from now on, as many as when the passes were declared.
  void setViews(std::span<const glsl::ShadowView> views);
  /// Declares the passes "specular front" (nearest surfaces) and "specular back" (farthest surfaces of the
  /// instances that the front shows) on behalf of `owner`. `views` is a storage buffer of the views; `size`
  /// is the number of texels per side. The object must outlive the graph.
  void add(frame::FrameGraph& graph, const SceneHandles& handles, frame::BufferHandle views, int size,
           GeometricNormals normals, const char* owner);

  /// Returns how wide the widest specular object is now, in metres: no way through one is longer. Searches
  /// for where light leaves an object have their points over so far, and not to the other objects: these
  /// would draw the points apart, and a body would lose its folds because of something far away.
  float widest() const;

  const SpecularBuffer& front() const { return front_; }
  const SpecularBuffer& back() const { return back_; }

 private:
  SpecularBuffer addPass(frame::FrameGraph& graph, const SceneHandles& handles, frame::BufferHandle views,
                         int size, bool normals, const char* owner, const SpecularBuffer* front);

  scene::GpuScene& scene_;
  std::vector<scene::DepthView> depthViews_;
  SpecularBuffer front_, back_;
  scene::DrawList frontList_, backList_;
};

}  // namespace limn::caustics
