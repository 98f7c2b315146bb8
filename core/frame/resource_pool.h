// The inside of ResourcePool.
#pragma once

#include <memory>
#include <vector>

#include "core/frame/graph_data.h"

namespace limn::frame {

/// Objects are lent as shared pointers: one that only the pool holds is free.
struct ResourcePool::Implementation {
  gpu::Device& device;
  std::vector<std::shared_ptr<gpu::Texture>> textures;
  std::vector<std::shared_ptr<gpu::Buffer>> buffers;

  std::shared_ptr<gpu::Texture> texture(std::string_view label, const gpu::TextureDesc& desc);
  std::shared_ptr<gpu::Buffer> buffer(std::string_view label, size_t bytes);
};

}  // namespace limn::frame
