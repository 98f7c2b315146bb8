#include "apps/view/texture_pool.h"

#include <algorithm>
#include <atomic>

namespace limn::app {
namespace {

bool isUnused(const std::shared_ptr<gpu::Texture>& texture) {
  if (texture.use_count() > 1) return false;
  std::atomic_thread_fence(std::memory_order_acquire);  // what its last user did happened before
  return true;
}

}  // namespace

std::shared_ptr<gpu::Texture> TexturePool::unused(int width, int height, GLenum filter) {
  const gpu::TextureDesc desc = gpu::resolved({.format = GL_RGBA8, .width = width, .height = height});
  auto found = std::ranges::find_if(
      textures_, [&](const auto& texture) { return texture->desc() == desc && isUnused(texture); });
  if (found == textures_.end()) {
    textures_.push_back(std::make_shared<gpu::Texture>(device_, "shown", desc));
    found = textures_.end() - 1;
  }
  (*found)->setSampling(filter, filter);
  return *found;
}

std::shared_ptr<const gpu::Texture> TexturePool::copyOf(const gpu::Texture& source, GLenum filter) {
  const gpu::TextureDesc& desc = source.desc();
  auto copy = unused(desc.width, desc.height, filter);
  device_.gl().CopyImageSubData(source.id(), GL_TEXTURE_2D, 0, 0, 0, 0, copy->id(), GL_TEXTURE_2D, 0, 0, 0, 0,
                                desc.width, desc.height, 1);
  return copy;
}

std::shared_ptr<const gpu::Texture> TexturePool::of(const Image8& image) {
  auto texture = unused(image.width, image.height, GL_NEAREST);
  texture->upload(0, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.data.data());
  return texture;
}

void TexturePool::trim() {
  constexpr size_t spare = 4;  // of a size that may come again with the next frame
  size_t kept = 0;
  std::erase_if(textures_, [&](const auto& texture) { return isUnused(texture) && ++kept > spare; });
}

}  // namespace limn::app
