// Declares the service that traces caustic rays: techniques request the light that some lights send through
// or off the scene's specular objects. It is traced once per graph, however many techniques request it, and
// kept while nothing but the camera changes (thesis, section 8.3.2).
//
// Each layer is a view of the specular objects from a light, or from a point on a light with extent. The
// stages are the depth of the scene without specular objects as the light sees it (ShadowMapService), the
// front and back of the specular objects (nearest and farthest surface, normal, instance), and the rays made
// from these: every texel is a light ray, which is reflected at the front, or refracted at the front and
// again at the back, both in image space.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/technique.h"
#include "glsl/caustics/caustic_ray.glsl"

namespace limn::caustics {

struct CausticRayDesc {
  int size = 256;       ///< texels per side of the specular buffers: rays per layer and path are its square
  int sceneSize = 512;  ///< texels per side of the depth maps of the rest of the scene
  uint32_t paths = glsl::caustic_reflection | glsl::caustic_refraction;
  int lightSamples = 1;  ///< points on each light with extent; 1: its centre
  int steps = 64;        ///< of the search for a ray's intersection with the scene
  int exitSteps = 32;    ///< of the search for where light inside an object leaves it
  /// Number of points at which a medium's grid is looked up on the light's way to an object, as in
  /// scene::MediumInput.
  int mediumSteps = scene::kCoreMediumSteps;
  bool operator==(const CausticRayDesc&) const = default;
};

/// Holds the rays of a request. The index of ray (x, y) of layer l and path p (0: the first of `paths`) is
/// ((p * layers + l) * size + y) * size + x.
struct CausticRays {
  frame::BufferHandle rays;  ///< storage buffer of glsl::CausticRay; empty: no light meets a specular object
  shadow::ShadowMaps scene;  ///< the rest of the scene as the lights see it: where rays end
  int sceneLights = 0;       ///< entries of scene.lights
  /// Holds a storage buffer of glsl::CausticLayer, one per layer; `light` indexes scene.lights.
  frame::BufferHandle layerLights;
  int layers = 0, size = 0, paths = 0;
  int pointLayers = 1;  ///< most layers of one point on a light: 1, or 6 where some point has several
  int count() const { return layers * size * size * paths; }
};

/// Provides caustic rays. Requests the rest of the scene as the lights see it from shadow::ShadowMapService.
class LIMN_API CausticRayService : public FrameService {
 public:
  static constexpr const char* serviceName = "caustic rays";

  CausticRayService(gpu::Device& device, scene::GpuScene& scene);
  ~CausticRayService() override;

  /// Returns the rays of `lights` (indices into Pose::lights). Lights that stand for the environment have
  /// none, and neither have those whose cone, range or side keeps all of their light from specular objects.
  /// Throws UsageError when the rays would take too much memory.
  CausticRays request(std::span<const uint32_t> lights, const CausticRayDesc& desc);

 private:
  void begin() override;
  /// Refits the views. Returns true when a light needs another number of layers, when one that had no rays
  /// reaches a specular object, or when specular objects appeared or disappeared.
  bool update(frame::FrameGraph& graph, const scene::Pose& pose) override;

  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::caustics
