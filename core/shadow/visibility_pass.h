// What every shadow-map technique's visibility pass has in common: parameters, declared reads, bindings
// (glsl/visibility.glsl) and the dispatch over pixels and lights.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/technique.h"

namespace limn::shadow {

/// The parameters that all techniques with shadow maps share.
constexpr Parameter shadowMapSizeParameter(int texels = 1024) {
  return integer("shadow_map_size", texels, {16, 16384}, "texels",
                 "Width and height of each layer of the shadow maps")
      .quality()
      .logScale();
}
constexpr const char* mapFits[] = {"scene", "view"};
constexpr Parameter shadowMapFitParameter() {
  return choice(
      "shadow_map_fit", 0, mapFits,
      "What maps of one view cover: all that the light reaches, or what the camera sees of it and what "
      "may block light from there");
}
constexpr Parameter biasParameter() {
  return real("bias", 1, {0, 64}, "texel footprints",
              "How far a blocker must lie above the receiver's tangent plane to count");
}
constexpr Parameter lightSizeParameter() {
  return real("light_size", -1, {-1, 1e6}, "m",
              "Side of every light (directional: angular diameter in radians); negative: the scene's");
}

/// A texture that a pass samples besides its maps.
struct SampledTexture {
  unsigned unit;
  frame::TextureHandle texture;
  const char* why;  ///< as for PassBuilder::read()
};

/// Of the maps of a technique that declares shadow_map_size, and maybe shadow_map_fit (else: scene) and
/// light_size.
LIMN_API ShadowMapDesc shadowMapDesc(const ParameterValues& parameters);

/// Units of glsl/blocker_search.glsl and of the table or maps that a technique derives.
constexpr unsigned minMaxUnit = 9, tableUnit = 10;

struct VisibilityPass {
  std::string_view name;       ///< of the pass
  std::string_view technique;  ///< whose it is
  gpu::ProgramDesc program;    ///< a compute shader that includes glsl/visibility.glsl and writes image 0
  ShadowMaps maps;
  float bias = 1;                            ///< texel footprints
  std::optional<float> lightSize = -1;       ///< < 0: the scene's; nullopt: the program asks for no light
  std::vector<SampledTexture> sampled = {};  ///< declared and bound
  /// Sets further uniforms and binds what `declare` declared; may be empty.
  std::function<void(frame::PassContext&, gpu::Program&)> bind = {};
  std::function<void(frame::PassBuilder&)> declare = {};
  /// Whether the pass adds to what `target` holds already (sums over batches of samples).
  bool accumulate = false;
};

/// The pass of a technique that declares the parameters above (shadow_map_fit and light_size may be missing):
/// maps of the request's lights, and the program of techniques/NAME/visibility.comp.glsl.
LIMN_API VisibilityPass visibilityPass(const TechniqueInputs& inputs, const TermRequest& request,
                                       std::string_view technique,
                                       std::map<std::string, std::string> defines = {});

/// Adds what glsl/gbuffer_input.glsl needs for pixel_surface(): to a pass that reflects light.
LIMN_API void readSurfaces(VisibilityPass& pass, const GBuffer& gbuffer);

/// Declares the pass; it writes one layer of `target` per light of the request. Returns the target after it.
LIMN_API frame::TextureHandle addVisibilityPass(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                frame::TextureHandle target, VisibilityPass pass);

}  // namespace limn::shadow
