#include "core/rays/coverage.h"

#include <bit>
#include <limits>

#include "core/base/error.h"
#include "glsl/rays/ray_coverage.glsl"
#include "glsl/rays/ray_node.glsl"

namespace limn::rays {
namespace {

uint32_t wordOf(scene::Wrap wrap) {
  switch (wrap) {
    case scene::Wrap::clamp:
      return glsl::ray_wrap_clamp;
    case scene::Wrap::mirror:
      return glsl::ray_wrap_mirror;
    case scene::Wrap::repeat:
      break;
  }
  return glsl::ray_wrap_repeat;
}

/// Appends texture coordinates and alpha of a triangle's vertices.
void appendCorners(std::vector<uint32_t>& words, const scene::Primitive& primitive, uint32_t triangle) {
  const uint32_t* vertex = &primitive.indices[3 * static_cast<size_t>(triangle)];
  glm::vec3 alpha(1);
  for (int k = 0; k < 3; ++k) {
    const glm::vec2 uv = primitive.uvs.empty() ? glm::vec2(0) : primitive.uvs[vertex[k]];
    words.insert(words.end(), {std::bit_cast<uint32_t>(uv.x), std::bit_cast<uint32_t>(uv.y)});
    if (!primitive.colours.empty()) alpha[k] = primitive.colours[vertex[k]].a;
  }
  words.insert(words.end(), {glm::packHalf2x16({alpha.x, alpha.y}), glm::packHalf2x16({alpha.z, 0.f})});
}

}  // namespace

CoverageTable::CoverageTable(const scene::Scene& scene) : scene_(scene) {}

uint32_t CoverageTable::add(const scene::Primitive& primitive, const scene::Material& material,
                            std::span<const uint32_t> order) {
  if (!(material.alphaCutoff > 0)) return glsl::ray_opaque;
  const scene::TextureRef& texture = material.baseColourTexture;
  const scene::TextureImage* image = texture.image == scene::kNone || primitive.uvs.empty()
                                         ? nullptr
                                         : &scene_.images[static_cast<size_t>(texture.image)];
  const bool textured = image != nullptr && !image->levels.empty();
  const uint32_t texels = textured ? texelsOf(*image, texture.image) : 0;
  const auto header = static_cast<uint32_t>(words_.size());
  words_.resize(header + glsl::ray_mask_words);
  const auto set = [&](uint32_t word, uint32_t value) { words_[header + word] = value; };
  set(glsl::ray_mask_corners, header + glsl::ray_mask_words);
  set(glsl::ray_mask_texels, texels);
  set(glsl::ray_mask_width, textured ? static_cast<uint32_t>(image->levels[0].width) : 0);
  set(glsl::ray_mask_height, textured ? static_cast<uint32_t>(image->levels[0].height) : 0);
  set(glsl::ray_mask_wraps, wordOf(texture.wrapS) | wordOf(texture.wrapT) << 2);
  set(glsl::ray_mask_factor, std::bit_cast<uint32_t>(material.baseColour.a));
  set(glsl::ray_mask_cutoff, std::bit_cast<uint32_t>(material.alphaCutoff));
  for (const uint32_t triangle : order) appendCorners(words_, primitive, triangle);
  if (words_.size() > std::numeric_limits<uint32_t>::max())
    throw UsageError("alpha masks of the scene take more than the 16 GiB that rays can look up");
  return header;
}

uint32_t CoverageTable::texelsOf(const scene::TextureImage& image, int number) {
  const auto [found, fresh] = texels_.emplace(number, static_cast<uint32_t>(words_.size()));
  if (!fresh) return found->second;
  const std::vector<uint8_t>& rgba = image.levels[0].rgba;
  const size_t texels = rgba.size() / 4;
  words_.resize(words_.size() + (texels + 3) / 4, 0);
  for (size_t i = 0; i < texels; ++i)
    words_[found->second + i / 4] |= uint32_t{rgba[4 * i + 3]} << 8 * (i % 4);
  return found->second;
}

}  // namespace limn::rays
