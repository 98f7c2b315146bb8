// Declares how a pass answers for lights of several kinds: lights whose maps are laid out alike share a
// dispatch, whose program is compiled for them. The shaders' side is glsl/shadow/alike_lights.glsl.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/shadow/shadow_map.h"

namespace limn::shadow {

/// Holds the lights of one dispatch, at most as many as light_layers in glsl/shadow/alike_lights.glsl holds.
struct LIMN_API AlikeLights {
  std::optional<LightLayout> layout = {};  ///< of all of them; empty: they are not alike
  std::vector<int> layers = {};            ///< their places in the request

  /// Adds what the program is compiled for.
  void define(std::map<std::string, std::string>& defines) const;
  /// Sets light_layers.
  void bind(gpu::Program& program) const;
};

/// Returns the dispatches for all lights of a request, in the order of their first lights.
LIMN_API std::vector<AlikeLights> alikeLights(std::span<const LightLayout> layouts);

/// Declares in `pass` the reads of the maps, and adds to `defines` how its programs declare them.
LIMN_API void readMaps(frame::PassBuilder& pass, const gpu::Device& device, const ShadowMaps& maps,
                       std::map<std::string, std::string>& defines);

}  // namespace limn::shadow
