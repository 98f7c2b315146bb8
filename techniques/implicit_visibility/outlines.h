// Lists what may hide lights from the surface around leaves, so that outlines are found for pixels instead of
// being interpolated between leaves.
#pragma once

#include <deque>
#include <optional>
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

  /// Returns lists of `lights`, with room for kPerLeaf triangles of each leaf and light. In scenes of more
  /// than kMostLights there are none: each light matters little there and takes as much time as one alone.
  std::optional<OutlineLists> lists(const PassRequest& r, std::span<const uint32_t> lights);

 private:
  /// Lights of a scene, those not asked for included.
  static constexpr size_t kMostLights = 16;
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
