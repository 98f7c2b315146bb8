// Declares the radiance cache: light that the lobes of materials reflect of the environment, by normal, for
// the one view from the middle of the picture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"

namespace limn::subtractive_shadows {

/// A material that has a lobe and is not in the cache, and why.
struct UncachedMaterial {
  int material = 0;
  const char* why = "";
};

/// Says which materials have layers of the cache: those that something is drawn with and whose lobe is the
/// same all over, as many as fit. Materials without a model share those of their roughness.
struct CachedMaterials {
  std::vector<uint32_t> materials;  ///< of each place
  std::vector<uint32_t> places;     ///< of each material; glsl::no_instance: none
  std::vector<UncachedMaterial> uncached;

  /// `answered`: a technique answers Term::surface, so that lobes of models are not in the cache.
  CachedMaterials(const scene::Scene& scene, const scene::Pose& pose, bool answered);
};

/// The most places that the cache has: 64 MiB.
inline constexpr size_t kMostCached = 128;

class RadianceCache {
 public:
  /// Declares the pass that makes the cache of `samples` samples a lobe, owned by `technique`, and what is
  /// left out of it. Returns whether the cache holds anything. Once per graph.
  bool add(frame::FrameGraph& graph, const TechniqueInputs& inputs, std::string_view technique, int samples);
  /// Declares what cached_environment.glsl reads besides the frame block and surfaces. `instances`: the pass
  /// has no G-buffer of instances otherwise.
  void read(frame::PassBuilder& pass, const TechniqueInputs& inputs, bool instances) const;

 private:
  gpu::Buffer materials_, places_;
  gpu::Sampler sampler_;
  frame::TextureHandle texture_;
  frame::BufferHandle placesHandle_;
};

}  // namespace limn::subtractive_shadows
