// Copies of pictures that one context makes and another draws.
#pragma once

#include <memory>
#include <vector>

#include "core/gpu/objects.h"
#include "core/image/image.h"

namespace limn::app {

/// Gives out textures of which nobody else holds a reference any more, so that none is written to while it is
/// drawn. Lives, and its textures are made and destroyed, on the thread of `device`: what was given out must
/// have been dropped when it is destroyed.
class TexturePool {
 public:
  explicit TexturePool(gpu::Device& device) : device_(device) {}

  /// A copy of `source` (RGBA8, 2D), shown with `filter`. It can be used in other contexts once the GPU has
  /// done everything asked of it.
  std::shared_ptr<const gpu::Texture> copyOf(const gpu::Texture& source, GLenum filter);
  /// A texture that holds `image`.
  std::shared_ptr<const gpu::Texture> of(const Image8& image);
  /// Frees most of what is not used.
  void trim();

 private:
  std::shared_ptr<gpu::Texture> unused(int width, int height, GLenum filter);

  gpu::Device& device_;
  std::vector<std::shared_ptr<gpu::Texture>> textures_;
};

}  // namespace limn::app
