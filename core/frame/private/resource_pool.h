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

  std::shared_ptr<gpu::Texture> texture(std::string_view label, const gpu::TextureDesc& desc);
  std::shared_ptr<gpu::Buffer> buffer(std::string_view label, size_t bytes);
};

}  // namespace limn::frame
