// Holds pictures on the window's side: textures of its own context, filled from what the rendering thread
// hands over.
#pragma once

#include <memory>
#include <vector>

#include "core/gpu/objects.h"
#include "core/image/image.h"

namespace limn::app {

/// Keeps each picture in a texture for as long as it is shown.
class WindowTextures {
 public:
  /// Takes `device`, which is that of the window's context and must outlive this object.
  explicit WindowTextures(gpu::Device& device) : device_(device) {}

  /// Returns the texture that holds `image` (not null), shown with `filter`. The image is uploaded the first
  /// time.
  const gpu::Texture& of(const std::shared_ptr<const Image8>& image, GLenum filter);
  /// Ends a frame: a texture that was not asked for in it may hold another picture from now on, and is freed
  /// after a second frame without use.
  void endFrame();

 private:
  struct Entry {
    gpu::Texture texture;
    std::shared_ptr<const Image8> image;  ///< null: free to hold another one
    bool used = false;                    ///< in this frame
  };
  gpu::Device& device_;
  std::vector<Entry> entries_;
};

}  // namespace limn::app
