// Shadow maps as a service: techniques ask for the maps of some lights at some size, the maps are rendered
// once per graph whoever asks, and derived resources (min-max pyramid, summed-area tables) are built when the
// first technique asks.
//
// A map is a layer of an R32F array. It holds linear depth: distance along the view axis of its ShadowView
// (along the ray for paraboloids), normalised to [0, 1] between the view's near and far; 1 where nothing is.
// Views, kernels and biases: glsl/shadow_view.glsl.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/scene/gpu_scene.h"
#include "core/shadow/derived_maps.h"
#include "core/shadow/fourier_maps.h"
#include "core/technique/technique.h"
#include "glsl/shadow_view.glsl"

namespace limn::shadow {

enum class Projection {
  automatic,   ///< by light: see ShadowMapService
  cube,        ///< six faces; point, spot and rectangle
  paraboloid,  ///< one layer per hemisphere (two for point lights); radial depth
};

/// What maps of one view cover; cubes, hemicubes, pairs and paraboloids cover the whole scene.
enum class MapFit {
  scene,  ///< everything that a light reaches, whoever looks
  view,   ///< what the camera sees of it, and what may block light from there: redrawn when that changes
};

struct ShadowMapDesc {
  int size = 1024;  ///< texels per side of each layer
  Projection projection = Projection::automatic;
  /// Points on each light from which maps are rendered, in the unit square as light_view_point() takes them;
  /// (1/2, 1/2) is the centre. Empty: the centre alone. Lights without extent have one map, which all samples
  /// share.
  std::vector<glm::vec2> samples = {};
  /// Keep the maps while nothing changed, as long as all that are kept take no more than some memory. False
  /// where many batches of maps are to share one piece of memory.
  bool cacheable = true;
  /// The maps hold what reflects the light, too: glsl/reflective_map.glsl. Not for paraboloids.
  bool reflective = false;
  /// Specular surfaces are in the maps.
  bool specular = true;
  MapFit fit = MapFit::scene;
  /// MapFit::view: size of the lights, as light_view() takes it; < 0: the scene's.
  float lightSize = -1;
  bool operator==(const ShadowMapDesc&) const = default;
};

/// The maps of a request. `lights` holds one glsl::ShadowLight per light and sample, light-major: where its
/// layers are.
struct ShadowMaps {
  frame::TextureHandle depth;   ///< R32F array
  frame::TextureHandle normal;  ///< reflective: RG16_SNORM array, geometric normal on the light's side
  frame::TextureHandle albedo;  ///< reflective: RGB10_A2 array, square root of the diffuse albedo
  frame::BufferHandle views;    ///< storage buffer of glsl::ShadowView, index = layer
  frame::BufferHandle lights;   ///< storage buffer of glsl::ShadowLight
  int layers = 0;
  int size = 0;
  uint32_t index = 0;  ///< of the request, for the functions below
};

/// What --stats reports about one light's maps.
struct ShadowMapStats {
  std::string light;
  std::string projection;  ///< perspective, orthographic, cube, hemicube, paraboloid
  int layers = 0;
  float near = 0, far = 0;  ///< metres, of the first layer
  float halfAngle = 0;      ///< radians, perspective only
};

/// Views of fit `view` may be off the light's axis (glsl::ShadowView::middle): cuts of those of fit `scene`,
/// and never larger.
///
/// Chosen automatically: point light: cube. Spot: perspective over its cone up to 75 degrees half angle, else
/// cube. Directional: orthographic around the scene. Rectangle: perspective from its centre, half angle
/// fitted to the scene up to 75 degrees, beyond that a hemicube (five faces); two-sided: the same for both
/// sides.
class LIMN_API ShadowMapService {
 public:
  ShadowMapService(gpu::Device& device, scene::GpuScene& scene);
  ~ShadowMapService();
  ShadowMapService(const ShadowMapService&) = delete;
  ShadowMapService& operator=(const ShadowMapService&) = delete;

  /// Forgets the requests of the former graph: call before building a new one.
  void begin(frame::FrameGraph& graph, const SceneHandles& handles, const scene::Pose& pose);
  /// The graph is about to be destroyed.
  void forget();
  /// Maps for `lights` (indices into Pose::lights), declared in the graph at the first request; equal
  /// requests share them. Throws UsageError if the maps would take more memory or layers than the device has.
  ShadowMaps request(std::span<const uint32_t> lights, const ShadowMapDesc& desc);
  /// Maps for parallel light along `directions` (unit, of propagation) that belongs to no light of the pose:
  /// one orthographic map around the scene for each, and a ShadowLight whose light is glsl::no_light. Samples
  /// of `desc` are not used.
  ShadowMaps request(std::span<const glm::vec3> directions, const ShadowMapDesc& desc);

  /// Resources derived from the maps of a request, built once per graph whoever asks.
  MinMaxPyramid minMaxPyramid(const ShadowMaps& maps);
  frame::TextureHandle minMaxWindows(const ShadowMaps& maps);
  frame::TextureHandle nBuffer(const ShadowMaps& maps);
  SummedAreaTable summedAreaTable(const ShadowMaps& maps, const SatDesc& desc);
  MomentTable momentTable(const ShadowMaps& maps, int bits);
  frame::TextureHandle momentMips(const ShadowMaps& maps);
  FourierMaps fourierMaps(const ShadowMaps& maps, const FourierDesc& desc);

  /// Refits near, far and half angles to the pose (after GpuScene::update) and touches the view buffers that
  /// changed. True: some light needs another number of layers now, so the graph must be rebuilt.
  bool update(const scene::Pose& pose);

  /// Layers that one light takes with this description, without requesting it.
  int layersOf(uint32_t light, const ShadowMapDesc& desc) const;
  std::vector<ShadowMapStats> stats() const;

  /// Binds the counter of pixels (times lights) that no map covers, for atomic increments by visibility
  /// passes. It lies outside the graph, so that counting orders no passes; update() sets it to 0.
  void bindCoverage(unsigned storageBinding) const;
  /// Since the last update(). Blocks: for statistics and tests.
  uint32_t uncoveredPixels() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::shadow
