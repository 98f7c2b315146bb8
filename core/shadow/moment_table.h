// Declares summed-area tables of four power moments of depth (Peters et al. 2017), which bound the share of a
// box that lies nearer than any given depth.
#pragma once

#include "core/frame/frame_graph.h"

namespace limn::shadow {

/// Holds a moment table. Lookups are in glsl/shadow/moment_shadow.glsl.
struct MomentTable {
  frame::TextureHandle texture;  ///< RGBA32UI array of one level
  int bits = 0;                  ///< of each moment of a texel
};

/// Returns the bits of a moment with which boxes of an eighth of a map's side are exact, limited to 14 to 20.
LIMN_API int momentBits(int mapSize);

/// Declares the passes that build the table of `source`, an R32F array with values in [0, 1], and returns the
/// table. Throws UsageError for bits outside 10 to 20 and tables beyond 4 GiB.
LIMN_API MomentTable addMomentTable(frame::FrameGraph& graph, frame::TextureHandle source, bool cacheable,
                                    int bits, bool shared);

}  // namespace limn::shadow
