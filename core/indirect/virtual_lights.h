// Declares the service that samples virtual point lights: techniques request N of them for some lights. They
// are sampled from reflective shadow maps once per graph, however many techniques request them, and kept
// while nothing changes.
//
// Sampling (glsl/indirect/sample_maps.comp.glsl): point i of the Halton sequence chooses a layer of the maps
// in proportion to the flux that the layer reflects, and a texel of it. N is therefore split among the lights
// by their contribution. A group is one face of one light, whose maps from several points of the light share
// one factor for each channel (glsl/indirect/conserve_flux.comp.glsl): the sum over its virtual lights is the
// flux that it reflects. What groups reflect that no sample met, as where a light's share is below one
// virtual light, is shared among the other groups in proportion to theirs, so that the sum over all virtual
// lights is the flux that all maps reflect, in every channel that a sample met; the light of a channel that
// no sample met is lost.
//
// Surfaces get of a light what the medium leaves of it (T_l, glsl/media/light_transmittance.glsl).
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/technique.h"
#include "glsl/indirect/virtual_light.glsl"

namespace limn::indirect {

struct VirtualLightDesc {
  int count = 1024;      ///< N
  int mapSize = 256;     ///< texels per side of each layer of the reflective shadow maps
  int lightSamples = 1;  ///< points on each light with extent that maps are drawn from; 1: its centre
  int sets = 1;          ///< frame i has set i % sets of as many disjoint sets; 1: all have the same lights
  /// Side of the pattern of interleaved pixels (glsl/indirect/gather.glsl). The sets of each sub-buffer are
  /// consecutive, as though it had the lights of all sets.
  int block = 1;
  bool operator==(const VirtualLightDesc&) const = default;
};

struct VirtualLights {
  frame::BufferHandle lights;  ///< storage buffer of glsl::VirtualPointLight
  frame::BufferHandle
      reflected;            ///< storage buffer of vec4: rgb flux that each layer of the maps reflects, W
  shadow::ShadowMaps maps;  ///< reflective
  int count = 0;
};

/// Provides virtual lights. Requests their maps from shadow::ShadowMapService.
class LIMN_API VirtualLightService : public FrameService {
 public:
  static constexpr const char* serviceName = "virtual lights";

  /// `scene` must outlive the service.
  explicit VirtualLightService(const scene::Scene& scene) : scene_(scene) {}

  /// Returns virtual lights of `lights` (indices into Pose::lights, at least one). Throws UsageError when the
  /// maps would take too much memory.
  VirtualLights request(std::span<const uint32_t> lights, const VirtualLightDesc& desc);

 private:
  void begin() override;

  struct Known {
    std::vector<uint32_t> lights;
    VirtualLightDesc desc;
    VirtualLights made;
  };
  const scene::Scene& scene_;
  std::vector<Known> known_;
};

/// Keeps what a technique makes of the virtual lights of some lights for as long as its graph. A scene with
/// translucent surfaces asks it once with each G-buffer (TechniqueInputs::gbuffer), and what does not depend
/// on the surfaces that are lit is made once for both.
template <class Made>
class MadeForLights {
 public:
  /// Returns what was made for these lights (indices into Pose::lights): what `make` returns, which is called
  /// the first time.
  template <class Make>
  Made& get(std::span<const uint32_t> lights, Make make) {
    for (auto& [known, made] : made_)
      if (std::ranges::equal(known, lights)) return made;
    return made_.emplace_back(std::vector<uint32_t>(lights.begin(), lights.end()), make()).second;
  }

 private:
  std::deque<std::pair<std::vector<uint32_t>, Made>> made_;
};

}  // namespace limn::indirect
