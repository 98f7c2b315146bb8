// Lists what may hide lights from the surface around leaves, so that outlines are found for pixels instead of
// being interpolated between leaves.
#pragma once

#include <deque>
#include <span>
#include <string_view>
#include <vector>

#include "core/radiosity/blocker_lists.h"
#include "techniques/implicit_visibility/element_passes.h"

namespace limn::implicit_visibility {

/// Holds the lists of some lights as show_visibility.comp.glsl reads them.
struct OutlineLists {
  frame::BufferHandle ranges, triangles;
};

/// Declares the passes that make lists on the processor. The object must outlive the graph.
class Outlines {
 public:
  Outlines(const ElementPasses& elements, std::string_view technique)
      : elements_(elements), technique_(technique) {}

  /// Returns the lists of `lights`, for as many triangles as kPerLeaf leaves room for.
  OutlineLists lists(const PassRequest& r, std::span<const uint32_t> lights);

 private:
  /// Triangles of each leaf's list and light that there is room for, on average over all leaves.
  static constexpr size_t kPerLeaf = 128;

  /// Holds the lists of one request in the processor's memory and in the GPU's.
  struct Lists {
    std::vector<uint32_t> lights;
    std::vector<radiosity::LightBounds> bounds;
    radiosity::BlockerLists lists;
    gpu::Buffer ranges, triangles;
  };

  const ElementPasses& elements_;
  std::string_view technique_;
  std::deque<Lists> lists_;  ///< the graph keeps their addresses
};

}  // namespace limn::implicit_visibility
