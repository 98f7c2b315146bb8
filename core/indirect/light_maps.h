// Declares one paraboloid map for each virtual point light: its view, and the passes that shade with one test
// per map. The techniques fill the maps.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/indirect/gather.h"
#include "core/indirect/paraboloid_maps.h"

namespace limn::indirect {

struct LightMapDesc {
  int size = 128;  ///< texels per side
  int batch = 1;   ///< maps that exist at once: virtual light i has layer i % batch
  std::string_view technique = "indirect";
};

/// Declares the pass "views" and returns its result: a storage buffer of glsl::ShadowView, a hemisphere for
/// each virtual light, offset from its surface by 1e-4 of the scene's diagonal. Views of lights without flux
/// look out of the scene, so that nothing is drawn for them.
LIMN_API frame::BufferHandle addLightViews(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                           const VirtualLights& lights, const LightMapDesc& desc);

/// Holds what some virtual lights have, whatever surfaces they light (MadeForLights).
struct LightMaps {
  frame::BufferHandle views;               ///< addLightViews()
  std::optional<ParaboloidMaps> all = {};  ///< where the maps of all lights exist at once

  /// Returns the maps of some of the lights: what `draw` returns, which is called once where those of all
  /// exist at once (`atOnce`). Batches share memory, so that each request draws them again.
  template <class Draw>
  ParaboloidMaps get(bool atOnce, Draw draw) {
    if (all) return *all;
    const ParaboloidMaps drawn = draw();
    if (atOnce) all = drawn;
    return drawn;
  }
};

/// Returns the pass that shades virtual lights maps.first to maps.first + maps.count. A receiver does not see
/// a light whose map holds, at the receiver's texel, something nearer that lies above the receiver's tangent
/// plane by more than `bias` texel footprints.
LIMN_API ShadePass lightMapShadePass(const TechniqueInputs& inputs, const ParaboloidMaps& maps, float bias);

/// Adds the light of virtual lights with a map each to the request's target, and returns the target after it.
/// The technique declares the parameter `bias` as well, and keeps in `made` what requests of one graph share.
/// `draw(views, desc)` returns the maps of some of the lights: those of all at once, or batch by batch.
template <class Draw>
frame::TextureHandle addMappedLight(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                    const TermRequest& request, const VirtualLights& lights,
                                    const LightMapDesc& desc, MadeForLights<LightMaps>& made, Draw draw) {
  LightMaps& maps = made.get(request.lights,
                             [&] { return LightMaps{.views = addLightViews(graph, inputs, lights, desc)}; });
  Gather gather(graph, inputs, desc.technique, lights, gatherSettings(inputs.parameters));
  for (int first = 0; first < lights.count; first += desc.batch) {
    const ParaboloidDesc part{.count = std::min(desc.batch, lights.count - first),
                              .first = first,
                              .size = desc.size,
                              .technique = desc.technique,
                              .cacheable = desc.batch == lights.count};
    const ParaboloidMaps drawn = maps.get(part.cacheable, [&] { return draw(maps.views, part); });
    gather.shade(lightMapShadePass(inputs, drawn, inputs.parameters.real("bias")));
  }
  return gather.finish(request.target);
}

}  // namespace limn::indirect
