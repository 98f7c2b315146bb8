// Shows the hierarchy of elements, and what one of them is linked to, in colours (thesis, figure 4.2).
#pragma once

#include <deque>
#include <string_view>
#include <vector>

#include "techniques/implicit_visibility/element_passes.h"

namespace limn::implicit_visibility {

/// Says what a picture shows: values of the technique's parameter `show`.
enum class Shown {
  light,
  level,  ///< elements of a level of the hierarchy
  links,  ///< elements that the one in the middle of the picture is linked to
  bins,   ///< the bins of directions through which it sees others
};
inline constexpr const char* kShownNames[] = {"light", "level", "links", "bins"};

/// Declares the pass that finds the colours of leaves on the processor. The object must outlive the graph.
class ElementColours {
 public:
  ElementColours(const ElementPasses& elements, std::string_view technique)
      : elements_(elements), technique_(technique) {}

  /// Returns a colour for each leaf slot, anything but `light`. `level`: above the leaves, whose level is 0.
  /// What is not linked is grey, the element itself white; where no element is in the middle of the picture,
  /// all are grey. Throws UsageError for links and bins of links made on the GPU.
  frame::BufferHandle colours(const PassRequest& r, Shown shown, int level);

 private:
  struct Buffer {
    std::vector<glm::vec4> values;
    std::vector<uint32_t> bins;  ///< in which elements are linked first, of all slots
    gpu::Buffer buffer;
  };

  void colourLevel(int level, std::span<glm::vec4> values) const;
  void colourLinks(uint32_t leaf, bool bins, Buffer& own) const;
  /// Returns the leaf that a ray meets, or glsl::no_link.
  uint32_t leafAt(const glm::vec3& from, const glm::vec3& ray) const;

  const ElementPasses& elements_;
  std::string_view technique_;
  std::deque<Buffer> buffers_;  ///< the graph keeps their addresses
};

}  // namespace limn::implicit_visibility
