// Declares the implementation of ResourcePool.
#pragma once

#include <memory>
#include <vector>

#include "core/frame/private/graph_data.h"

namespace limn::frame {

/// Holds objects and lends them as shared pointers: an object that only the pool holds is free.
struct ResourcePool::Implementation {
  gpu::Device& device;
  std::vector<std::shared_ptr<gpu::Texture>> textures;
  std::vector<std::shared_ptr<gpu::Buffer>> buffers;

  /// Returns a free one of that kind, which has the label from now on; null: there is none.
  std::shared_ptr<gpu::Texture> findTexture(std::string_view label, const gpu::TextureDesc& desc);
  std::shared_ptr<gpu::Buffer> findBuffer(std::string_view label, size_t bytes);
  std::shared_ptr<gpu::Texture> makeTexture(std::string_view label, const gpu::TextureDesc& desc);
  std::shared_ptr<gpu::Buffer> makeBuffer(std::string_view label, size_t bytes);
};

}  // namespace limn::frame
