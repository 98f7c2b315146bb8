// Caustic rays as a service: techniques ask for the light that some lights send through or off the scene's
// specular objects; it is traced once per graph whoever asks, and kept while nothing changed (thesis,
// section 8.3.2).
//
// Each layer is a view of the specular objects from a light, or from a point on a light with extent. Stages:
// the scene's depth without specular objects as the light sees it (ShadowMapService), front and back of the
// specular objects (nearest and farthest surface, normal, instance), and from these the rays: every texel is
// a light ray, which is reflected at the front, or refracted at the front and again at the back, both in
// image space.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/frame/frame_graph.h"
#include "core/scene/gpu_scene.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/technique.h"
#include "glsl/caustic_ray.glsl"

namespace limn::caustics {

struct CausticRayDesc {
  int size = 256;       ///< texels per side of the specular buffers: rays per layer and path are its square
  int sceneSize = 512;  ///< texels per side of the depth maps of the rest of the scene
  uint32_t paths = glsl::caustic_reflection | glsl::caustic_refraction;
  int lightSamples = 1;  ///< points on each light with extent; 1: its centre
  int steps = 64;        ///< of the search for where a ray meets the scene
  bool operator==(const CausticRayDesc&) const = default;
};

/// Ray (x, y) of layer l and path p (0: the first of `paths`) has the index ((p * layers + l) * size + y) *
/// size + x.
struct CausticRays {
  frame::BufferHandle rays;  ///< storage buffer of glsl::CausticRay; empty: no light meets a specular object
  shadow::ShadowMaps scene;  ///< the rest of the scene as the lights see it: where rays end
  int sceneLights = 0;       ///< entries of scene.lights
  /// Storage buffer of vec4, one per layer. x: which of scene.lights; y: diameter of the objects, m.
  frame::BufferHandle layerLights;
  int layers = 0, size = 0, paths = 0;
  int count() const { return layers * size * size * paths; }
};

class LIMN_API CausticRayService {
 public:
  CausticRayService(gpu::Device& device, scene::GpuScene& scene, shadow::ShadowMapService& shadowMaps);
  ~CausticRayService();
  CausticRayService(const CausticRayService&) = delete;
  CausticRayService& operator=(const CausticRayService&) = delete;

  /// Forgets the requests of the former graph: call before building a new one, after
  /// ShadowMapService::begin().
  void begin(frame::FrameGraph& graph, const SceneHandles& handles, const scene::Pose& pose);
  /// The graph is about to be destroyed.
  void forget();
  /// Rays of `lights` (indices into Pose::lights). Lights that stand for the environment have none. Throws
  /// UsageError where they would take too much memory.
  CausticRays request(std::span<const uint32_t> lights, const CausticRayDesc& desc);
  /// Refits the views to the pose (after GpuScene::update). True: some light needs another number of layers,
  /// or specular objects came or went, so the graph must be rebuilt.
  bool update(const scene::Pose& pose);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::caustics
