// Declares the service that renders shadow maps: techniques request the maps of some lights at some size. The
// maps are rendered once per graph, however many techniques request them, and derived resources (min-max
// pyramid, summed-area tables) are built when the first technique requests them.
//
// A map is a layer of an R32F array. It holds linear depth: distance along the view axis of its ShadowView,
// normalised to [0, 1] between the view's near and far; 1 where there is nothing. Views, kernels and biases
// are in glsl/shadow/shadow_view.glsl.
#pragma once

#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/shadow/derived_maps.h"
#include "core/shadow/fourier_maps.h"
#include "core/technique/technique.h"
#include "glsl/scene/light.glsl"
#include "glsl/shadow/shadow_view.glsl"

namespace limn::shadow {

enum class Projection {
  automatic,  ///< by light: see ShadowMapService
  cube,       ///< six faces; point, spot and rectangle
};

/// Says what maps of one view, and faces of samples' cubes and hemicubes, cover; others cover the whole
/// scene.
enum class MapFit {
  scene,  ///< everything that a light reaches, independent of the camera
  view,   ///< what the camera sees of it, within a light's range, and what may block its light: redrawn when
          ///< that changes
};

struct ShadowMapDesc {
  int size = 1024;  ///< texels per side of each layer
  Projection projection = Projection::automatic;
  /// Holds the points on each light from which maps are rendered, in the unit square as light_view_point()
  /// takes them; (1/2, 1/2) is the centre. Empty: the centre alone. Lights without extent have one map, which
  /// all samples share.
  std::vector<glm::vec2> samples = {};
  /// Holds the number of parts along the longer side of each light with extent, and along the shorter one in
  /// proportion: each has maps of its own, from its centre (glsl/light/light_part.glsl). 1: the light is
  /// whole; 0: as many as the light's size asks for (LightLayout says how many). Not together with samples.
  int views = 1;
  /// Says whether the maps are kept while nothing changes, as long as all kept maps fit a limit of memory.
  /// False when many batches of maps share one piece of memory.
  bool cacheable = true;
  /// Says whether anything is drawn into the maps of lights without extent. False where samples come in
  /// batches and those of an earlier one have been used: nobody looks into them.
  bool punctual = true;
  /// Says whether the maps also hold what reflects the light: glsl/indirect/reflective_map.glsl.
  bool reflective = false;
  /// Says whether reflective maps hold which draw instance a texel shows, in place of the albedo.
  bool instances = false;
  /// Says whether specular surfaces are in the maps.
  bool specular = true;
  MapFit fit = MapFit::scene;
  /// Holds the size of the lights for MapFit::view and parts, as light_view() takes it; < 0: the scene's.
  float lightSize = -1;
  bool operator==(const ShadowMapDesc&) const = default;
};

/// Returns `count` points for ShadowMapDesc::samples, of the R2 sequence, which lie alike on all sides of a
/// light's centre (glsl::r2_point). None for one point: maps are then of the centre.
LIMN_API std::vector<glm::vec2> pointsOnLights(int count);

/// Holds the maps of a request. `lights` holds one glsl::ShadowLight per light and sample, or part,
/// light-major: the place of its layers. Lights with fewer than others repeat their last one.
struct ShadowMaps {
  frame::TextureHandle depth;   ///< R32F array
  frame::TextureHandle normal;  ///< reflective: RG16_SNORM array, geometric normal on the light's side
  /// Reflective, without instances: RGB10_A2 array, square root of the diffuse albedo.
  frame::TextureHandle albedo;
  /// With instances: R32UI array, draw instance; no_instance for nothing and for the backs of surfaces that
  /// have one side.
  frame::TextureHandle instance;
  frame::BufferHandle views;   ///< glsl::ShadowView, index = layer
  frame::BufferHandle lights;  ///< glsl::ShadowLight
  int layers = 0;
  int lightSamples = 0;  ///< length of `lights`
  int stride = 1;        ///< entries of `lights` for each light
  int size = 0;
  uint32_t index = 0;  ///< of the request, for the functions below
};

/// Says how the maps of one light are laid out, and what its points are: what a program can be compiled for.
struct LightLayout {
  uint32_t projection = glsl::shadow_perspective;
  uint32_t faces = glsl::shadow_faces_single;
  uint32_t kind = glsl::light_kind_rectangle;
  uint32_t partsU = 1, partsV = 1;  ///< parts along each side
  uint32_t parts() const { return partsU * partsV; }
  auto operator<=>(const LightLayout&) const = default;
};

/// Holds what --stats reports about one light's maps.
struct ShadowMapStats {
  std::string light;
  std::string projection;  ///< perspective, orthographic, cube, hemicube
  int layers = 0;
  float near = 0, far = 0;  ///< metres, of the first layer that shows something; 0: none does
  float halfAngle = 0;      ///< radians, perspective only
};

/// Provides shadow maps. Views with MapFit::view may be off the light's axis (glsl::ShadowView::middle); they
/// are parts of those with MapFit::scene and never larger.
///
/// Projection::automatic chooses by light. Point light: cube. Spot: perspective over its cone up to 75
/// degrees half angle, else cube. Directional: orthographic around the scene. Rectangle: perspective from its
/// centre, with a half angle fitted to the scene up to 75 degrees, beyond that a hemicube (five faces);
/// two-sided: the same for both sides.
class LIMN_API ShadowMapService : public FrameService {
 public:
  static constexpr const char* serviceName = "shadow maps";

  ShadowMapService(gpu::Device& device, scene::GpuScene& scene);
  ~ShadowMapService() override;

  /// Returns maps for `lights` (indices into Pose::lights), declared in the graph at the first request. Equal
  /// requests share maps that are cacheable; batches are rendered for each, so that none of them is held
  /// until it is wanted again. Requests that differ in `views` alone share them while no light is cut, and so
  /// do those that differ in `fit` alone while no map follows the view (MapFit) and no light has a range.
  /// Throws UsageError when the maps would take more memory or layers than the device has.
  ShadowMaps request(std::span<const uint32_t> lights, const ShadowMapDesc& desc);
  /// Returns maps for parallel light along `directions` (unit, of propagation) that belongs to no light of
  /// the pose: one orthographic map around the scene for each, and a ShadowLight whose light is
  /// glsl::no_light. Samples of `desc` are not used. Requests share them as those of lights do.
  ShadowMaps request(std::span<const glm::vec3> directions, const ShadowMapDesc& desc);

  /// Returns the layout of each light of a request. While the graph lives they stay the same: update() has it
  /// built again when one changes.
  std::span<const LightLayout> layouts(const ShadowMaps& maps) const;

  /// Returns the resource derived from the maps of a request, as do the functions below; each is built once
  /// per graph, however many techniques request it. `boxSide` as for DerivedMaps.
  MinMaxPyramid minMaxPyramid(const ShadowMaps& maps, int boxSide = 0);
  frame::TextureHandle minMaxWindows(const ShadowMaps& maps);
  frame::TextureHandle nBuffer(const ShadowMaps& maps);
  SummedAreaTable summedAreaTable(const ShadowMaps& maps, const SatDesc& desc);
  MomentTable momentTable(const ShadowMaps& maps, int bits);
  FourierMaps fourierMaps(const ShadowMaps& maps, const FourierDesc& desc);

  /// Returns the number of layers that one light takes with this description, without requesting them.
  int layersOf(uint32_t light, const ShadowMapDesc& desc) const;
  std::vector<ShadowMapStats> stats() const;

  /// Returns the counter of pixels that no map covers, times lights, and times samples that have maps of
  /// their own: a storage buffer of one uint that visibility passes increment atomically; a pass sets it to 0
  /// in each frame. A pass that writes to it replaces the handle with the one that PassBuilder::write()
  /// returns. To be called before the writing pass is added.
  frame::BufferHandle& uncoveredCounter();
  /// Returns the count of the last frame. Blocks until the GPU has finished: for statistics and tests only.
  uint32_t uncoveredPixels() const;

 private:
  void begin() override;
  /// Refits near, far and half angles where lights, geometry or, for MapFit::view, the camera moved. Returns
  /// true when a light needs another layout, or another number of maps.
  bool update(frame::FrameGraph& graph, const scene::Pose& pose) override;

  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::shadow
