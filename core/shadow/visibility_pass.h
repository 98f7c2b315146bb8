// Declares what the visibility passes of all shadow-map techniques share: parameters, the inputs of
// glsl/shadow/visibility.glsl and the dispatch over pixels and lights.
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

/// Returns the parameter for the size of shadow maps. This and the functions below declare the parameters
/// that all techniques with shadow maps share.
constexpr Parameter shadowMapSizeParameter(int texels = 1024) {
  return integer("shadow_map_size", texels, {16, 16384}, "texels",
                 "Width and height of each layer of the shadow maps")
      .quality()
      .logScale();
}
constexpr const char* kMapFits[] = {"scene", "view"};
/// `fit`: the default, an index into kMapFits.
constexpr Parameter shadowMapFitParameter(int fit = 0) {
  return choice(
      "shadow_map_fit", fit, kMapFits,
      "What maps of one view cover, and the faces of half cubes of sampled lights: scene: all that the "
      "light reaches; view: what the camera sees of it, and what may block light from there");
}
constexpr Parameter biasParameter() {
  return real("bias", 1, {0, 64}, "texel footprints",
              "How far a blocker must lie above the receiver's tangent plane to count");
}
constexpr Parameter lightSizeParameter() {
  return real("light_size", -1, {-1, 1e6}, "m",
              "Side of every light (directional: angular diameter in radians); negative: the scene's");
}

constexpr Parameter viewsParameter(int perSide = 1) {
  return integer("views", perSide, {0, 8}, "per side",
                 "Parts of a light along its longer side, each filtered by itself in a shadow map from its "
                 "centre; 1: the light as a whole, as published; 0: 2 where its kernels are wide, else 1")
      .quality();
}

/// Names a texture that a pass samples in addition to its maps.
struct SampledTexture {
  frame::ShaderName name;  ///< of the sampler
  frame::TextureHandle texture;
  const char* why;  ///< as for PassBuilder::read()
};

/// Returns the description of the maps of a technique that declares shadow_map_size, and optionally
/// shadow_map_fit (default: scene), views (default: 1) and light_size.
LIMN_API ShadowMapDesc shadowMapDesc(const ParameterValues& parameters);

/// Returns the table of z and z^2 of a technique that declares sat_bits and sat_words, and looks up boxes of
/// up to `boxSide` x `boxSide` texels. Throws UsageError where the sums over such a box may overflow.
LIMN_API SummedAreaTable summedAreaTable(const TechniqueInputs& inputs, const ShadowMaps& maps, int boxSide);

struct VisibilityPass {
  std::string_view name;                  ///< of the pass
  std::string_view technique;             ///< owner of the pass
  gpu::ProgramDesc program;               ///< a compute shader that includes glsl/shadow/visibility.glsl
  std::string_view image = "visibility";  ///< the program's name for the target
  ShadowMaps maps;
  float bias = 1;                       ///< texel footprints
  std::optional<float> lightSize = -1;  ///< < 0: the scene's; nullopt: the program has no such uniform
  std::vector<SampledTexture> sampled = {};
  /// Says whether the program reflects light: it includes glsl/surface/surface_response.glsl and goes through
  /// all lights of the maps. Else it answers for one light per layer of the target.
  bool reflects = false;
  /// Sets further uniforms, and fills slots that `declare` announced; may be empty.
  std::function<void(frame::PassContext&, gpu::Program&)> bind = {};
  std::function<void(frame::PassBuilder&)> declare = {};
  /// Says whether the pass adds to the contents of `target` (sums over batches of samples).
  bool accumulate = false;
};

/// Returns the pass of a technique that declares the parameters above (shadow_map_fit, views and light_size
/// are optional), with maps of the request's lights and the program of techniques/NAME/visibility.comp.glsl.
LIMN_API VisibilityPass visibilityPass(const TechniqueInputs& inputs, const TermRequest& request,
                                       std::string_view technique,
                                       std::map<std::string, std::string> defines = {});

/// Declares the pass, which writes one layer of `target` per light of the request. Lights whose maps are laid
/// out alike share a dispatch, whose program is compiled for them (glsl/shadow/visibility.glsl says how).
/// Where the inputs ask for the bound, the program is visibility.comp.glsl, and each light is a rectangle in
/// one perspective view (which bounds are written for), the pass is called kBoundPass and runs kBoundFile
/// with the same defines. Returns the target after it.
LIMN_API frame::TextureHandle addVisibilityPass(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                frame::TextureHandle target, VisibilityPass pass);

}  // namespace limn::shadow
