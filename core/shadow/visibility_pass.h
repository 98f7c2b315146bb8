// What every shadow-map technique's visibility pass has in common: declared reads, bindings
// (glsl/visibility.glsl) and the dispatch over pixels and lights.
#pragma once

#include <functional>
#include <string_view>

#include "core/frame/frame_graph.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/technique.h"

namespace limn::shadow {

struct VisibilityPass {
  std::string_view name;       ///< of the pass
  std::string_view technique;  ///< whose it is
  gpu::ProgramDesc program;    ///< a compute shader that includes glsl/visibility.glsl and writes image 0
  ShadowMaps maps;
  float bias = 1;        ///< texel footprints
  float lightSize = -1;  ///< < 0: the scene's
  /// Sets further uniforms and binds what `declare` declared; may be empty.
  std::function<void(frame::PassContext&, gpu::Program&)> bind = {};
  std::function<void(frame::PassBuilder&)> declare = {};
  /// Whether the pass adds to what `target` holds already (sums over batches of samples).
  bool accumulate = false;
};

/// Declares the pass; it writes one layer of `target` per light of the request. Returns the target after it.
LIMN_API frame::TextureHandle addVisibilityPass(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                frame::TextureHandle target, VisibilityPass pass);

}  // namespace limn::shadow
