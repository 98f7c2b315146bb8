// Shows what leaves know as a picture: interpolated over the triangles between them, or gathered per pixel.
#pragma once

#include <optional>
#include <string_view>

#include "core/indirect/surface_lookup.h"
#include "techniques/implicit_visibility/element_passes.h"
#include "techniques/implicit_visibility/outlines.h"

namespace limn::implicit_visibility {

/// Declares the passes that show the leaves' light and visibility. The object must outlive the graph.
class Display {
 public:
  Display(const ElementPasses& elements, std::string_view technique)
      : elements_(elements), technique_(technique) {}

  /// Writes V of a batch of lights: `seen`, and where `lists` has lists, V of the pixels themselves.
  frame::TextureHandle visibility(const PassRequest& r, const SeenLights& seen,
                                  const std::optional<OutlineLists>& lists);
  /// Writes a picture of the leaves' colours instead of light.
  frame::TextureHandle colours(const PassRequest& r, frame::BufferHandle colours);
  /// Adds reflected light, by the technique's parameter `display`.
  frame::TextureHandle light(const PassRequest& r, const Gathered& light);

 private:
  /// Finds which leaves surround each pixel: the triangles between them, where they meet the G-buffer's
  /// surface.
  frame::TextureHandle lookup(const PassRequest& r);
  /// Shows light from the irradiance of vertices, or by the bins of `chunk`.
  frame::TextureHandle show(const PassRequest& r, const Gathered& light, const LinkChunk* chunk);

  const ElementPasses& elements_;
  std::string_view technique_;
  indirect::SurfaceLookup lookup_;
};

}  // namespace limn::implicit_visibility
