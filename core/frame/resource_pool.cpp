#include "core/frame/private/resource_pool.h"

#include <algorithm>

namespace limn::frame {
namespace {

/// Longest label every implementation accepts (GL_MAX_LABEL_LENGTH is at least 256, terminator included).
constexpr size_t kLongestLabel = 255;

void relabel(const gpu::Device& device, GLenum kind, GLuint id, std::string_view label) {
  const auto length = static_cast<GLsizei>(std::min(label.size(), kLongestLabel));
  device.gl().ObjectLabel(kind, id, length, label.data());
}

}  // namespace

std::shared_ptr<gpu::Texture> ResourcePool::Implementation::findTexture(std::string_view label,
                                                                        const gpu::TextureDesc& desc) {
  for (const auto& texture : textures) {
    if (texture.use_count() == 1 && texture->desc() == desc) {
      relabel(device, GL_TEXTURE, texture->id(), label);
      return texture;
    }
  }
  return nullptr;
}

std::shared_ptr<gpu::Texture> ResourcePool::Implementation::makeTexture(std::string_view label,
                                                                        const gpu::TextureDesc& desc) {
  return textures.emplace_back(std::make_shared<gpu::Texture>(device, label.substr(0, kLongestLabel), desc));
}

std::shared_ptr<gpu::Buffer> ResourcePool::Implementation::findBuffer(std::string_view label, size_t bytes) {
  for (const auto& buffer : buffers) {
    if (buffer.use_count() == 1 && buffer->size() == bytes) {
      relabel(device, GL_BUFFER, buffer->id(), label);
      return buffer;
    }
  }
  return nullptr;
}

std::shared_ptr<gpu::Buffer> ResourcePool::Implementation::makeBuffer(std::string_view label, size_t bytes) {
  return buffers.emplace_back(std::make_shared<gpu::Buffer>(device, label.substr(0, kLongestLabel), bytes));
}

ResourcePool::ResourcePool(gpu::Device& device)
    : implementation_(std::make_unique<Implementation>(Implementation{device, {}, {}})) {}

ResourcePool::~ResourcePool() = default;

void ResourcePool::trim() {
  std::erase_if(implementation_->textures, [](const auto& texture) { return texture.use_count() == 1; });
  std::erase_if(implementation_->buffers, [](const auto& buffer) { return buffer.use_count() == 1; });
}

int64_t ResourcePool::bytes() const {
  int64_t sum = 0;
  for (const auto& texture : implementation_->textures) sum += gpu::textureBytes(texture->desc());
  for (const auto& buffer : implementation_->buffers) sum += static_cast<int64_t>(buffer->size());
  return sum;
}

}  // namespace limn::frame
