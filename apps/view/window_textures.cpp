#include "apps/view/window_textures.h"

#include <algorithm>

namespace limn::app {

const gpu::Texture& WindowTextures::of(const std::shared_ptr<const Image8>& image, GLenum filter) {
  auto found = std::ranges::find(entries_, image, &Entry::image);
  if (found == entries_.end()) {
    const gpu::TextureDesc desc =
        gpu::resolved({.format = GL_RGBA8, .width = image->width, .height = image->height});
    found = std::ranges::find_if(
        entries_, [&](const Entry& entry) { return !entry.image && entry.texture.desc() == desc; });
    if (found == entries_.end()) {
      entries_.push_back({gpu::Texture(device_, "shown", desc), nullptr, false});
      found = entries_.end() - 1;
    }
    found->texture.upload(0, 0, GL_RGBA, GL_UNSIGNED_BYTE, image->data.data());
    found->image = image;
  }
  found->texture.setSampling(filter, filter);
  found->used = true;
  return found->texture;
}

void WindowTextures::endFrame() {
  std::erase_if(entries_, [](const Entry& entry) { return !entry.used && !entry.image; });
  for (Entry& entry : entries_) {
    if (!entry.used) entry.image.reset();
    entry.used = false;
  }
}

}  // namespace limn::app
