// Declares the service that samples virtual point lights: techniques request N of them for some lights. They
// are sampled from reflective shadow maps once per graph, however many techniques request them, and kept
// while nothing changes.
//
// Sampling (glsl/indirect/sample_maps.comp.glsl): point i of the Halton sequence chooses a layer of the maps
// in proportion to the flux that the layer reflects, and a texel of it. N is therefore split among the lights
// by their contribution; a light whose share is below one virtual light gives its flux to the others. The sum
// over all virtual lights is the flux that the maps reflect, in every channel, for each face of each light:
// the maps of one face from several points of the light share one factor.
#pragma once

#include <cstdint>
#include <span>
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
  std::vector<Known> known_;
};

}  // namespace limn::indirect
