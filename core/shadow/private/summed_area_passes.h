// Declares the passes that build the summed-area tables of shadow maps.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"

namespace limn::shadow {

/// Returns the description of a map derived from `source`, with `slices` layers for each of its layers.
/// Throws UsageError beyond 4 GiB.
gpu::TextureDesc derivedDesc(const frame::FrameGraph& graph, frame::TextureHandle source,
                             std::string_view what, GLenum format, int levels, int slices = 1);

struct SummedAreaPasses {
  std::string_view name;  ///< of the table
  /// Holds definitions for glsl/shadow/summed_area_table.comp.glsl: which quantity is summed.
  std::map<std::string, std::string> defines;
  bool shared;     ///< scans in shared memory instead of one thread per line
  bool cacheable;  ///< kept while nothing changes
};

/// Declares the passes that sum the R32F array `source` along rows, then along columns. Returns the table,
/// which is of `format`, one of integers.
frame::TextureHandle addSummedAreaPasses(frame::FrameGraph& graph, frame::TextureHandle source, GLenum format,
                                         const SummedAreaPasses& desc);

/// Declares the pass that sums `tables`, which hold sums along rows, along columns in place. They become the
/// versions after it.
void addColumnSums(frame::FrameGraph& graph, const std::vector<frame::TextureHandle*>& tables,
                   const SummedAreaPasses& desc);

/// Returns how many work groups take that many rows or columns (glsl/shadow/line_scan.glsl).
int lineGroups(int lines, bool shared, bool vertical);

}  // namespace limn::shadow
