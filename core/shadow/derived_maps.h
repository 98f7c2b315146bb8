// What shadow techniques look up instead of single texels of a shadow map: min-max pyramids, mip chains of
// moments. Each is built when the first technique asks, by passes of the frame graph, and shared by all that
// ask.
#pragma once

#include <memory>

#include "core/frame/frame_graph.h"

namespace limn::shadow {

/// RG32F array with a full mip chain: (least, greatest) depth. Lookups: glsl/min_max_pyramid.glsl.
struct MinMaxPyramid {
  frame::TextureHandle texture;
  int levels = 0;
};

/// The derived maps of one graph. A source is an R32F array with values in [0, 1]; `cacheable` says whether
/// its contents, and so the derived ones, are to be kept while nothing changes.
class LIMN_API DerivedMaps {
 public:
  explicit DerivedMaps(const gpu::Device& device);
  ~DerivedMaps();
  DerivedMaps(const DerivedMaps&) = delete;
  DerivedMaps& operator=(const DerivedMaps&) = delete;

  /// Forgets what was built in the former graph.
  void begin(frame::FrameGraph& graph);

  MinMaxPyramid minMaxPyramid(frame::TextureHandle depth, bool cacheable);
  /// RG32F array with a full mip chain: means of z and of z^2 over equal parts of the map; also where a size
  /// is odd the mean over each level is that of the map.
  frame::TextureHandle momentMips(frame::TextureHandle depth, bool cacheable);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::shadow
