// Declares the two passes that build every summed-area table of shadow maps.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/frame/frame_graph.h"

namespace limn::shadow {

/// Returns the description of a map derived from `source`, with `slices` layers for each of its layers.
/// Throws UsageError beyond 4 GiB.
gpu::TextureDesc derivedDesc(const frame::FrameGraph& graph, frame::TextureHandle source,
                             std::string_view what, GLenum format, int levels, int slices = 1);

struct SummedAreaPasses {
  std::string_view name;  ///< of the table
  GLenum format;          ///< an integer format
  /// Holds definitions for glsl/shadow/summed_area_table.comp.glsl: which quantity is summed, and the image's
  /// format.
  std::map<std::string, std::string> defines;
  bool shared;     ///< scans in shared memory instead of one thread per line
  bool cacheable;  ///< kept while nothing changes
};

/// Declares the passes that sum the R32F array `source` along rows, then along columns. Returns the table.
frame::TextureHandle addSummedAreaPasses(frame::FrameGraph& graph, frame::TextureHandle source,
                                         const SummedAreaPasses& desc);

}  // namespace limn::shadow
