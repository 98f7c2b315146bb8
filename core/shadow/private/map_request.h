// Declares one set of shadow maps that was requested: of which lights it is, how they are laid out, and what
// they are fitted to. Internal to ShadowMapService.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu/objects.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/shadow/private/lit_scene.h"
#include "core/shadow/shadow_map.h"
#include "glsl/scene/light.glsl"
#include "glsl/shadow/shadow_view.glsl"

namespace limn::shadow {

/// Holds one set of maps and what draws it.
struct MapRequest {
  std::vector<uint32_t> lights;
  std::vector<glm::vec3> directions;  ///< of parallel light, instead of lights
  ShadowMapDesc desc;
  ShadowMaps maps;
  bool kept = false;
  std::vector<LightLayout> layouts;
  std::vector<glsl::ShadowView> views;
  std::vector<glsl::ShadowLight> shadowLights;
  std::vector<scene::DepthView> depthViews;
  gpu::Buffer viewBuffer, lightBuffer;
  frame::BufferHandle importedViews, importedLights;
  scene::DrawList drawList;

  /// Returns the number of lights, or of directions.
  size_t count() const;
  /// Returns the i-th of them.
  glsl::Light lightAt(const LitScene& scene, size_t i) const;
  /// Returns the layouts that the lights of the scene ask for now. Lights that choose the number of their
  /// parts are cut as long as all maps of the request can be kept.
  std::vector<LightLayout> layoutsIn(const LitScene& scene) const;
  /// Computes the views again for the lights and bounds of the scene. Returns true if they changed.
  bool fit(const LitScene& scene);
  /// Throws UsageError where maps of these layouts are more than one request may have.
  void check(const LitScene& scene, const gpu::Device& device) const;

  /// Returns whether what the camera sees changes maps: with MapFit::view in some layouts.
  bool followsView() const;
  /// Returns whether the range of a light ends maps with MapFit::view.
  bool hasRange(const LitScene& scene) const;
  /// Returns whether a light has parts.
  bool cuts() const;
  /// Returns the entries of `shadowLights` for each light.
  size_t stride() const;
  /// Returns the bytes that the maps take.
  int64_t bytes() const;
  /// Appends what --stats says about each light.
  void report(const LitScene& scene, std::vector<ShadowMapStats>& all) const;
};

/// Returns the number of layers that one light takes in such a layout.
int layersOf(const glsl::Light& light, const LightLayout& layout, const ShadowMapDesc& desc);

}  // namespace limn::shadow
