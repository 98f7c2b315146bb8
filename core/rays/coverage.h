// Declares the alpha masks of what rays meet, as the words that glsl/rays/ray_coverage.glsl reads.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::rays {

class LIMN_API CoverageTable {
 public:
  explicit CoverageTable(const scene::Scene& scene);

  /// Appends the mask of a primitive whose triangles lie in `order`, and returns the first word of its
  /// header; glsl::ray_opaque where the material has no alpha cutoff. Throws UsageError beyond 2^32 words.
  uint32_t add(const scene::Primitive& primitive, const scene::Material& material,
               std::span<const uint32_t> order);
  const std::vector<uint32_t>& words() const { return words_; }

 private:
  uint32_t texelsOf(const scene::TextureImage& image, int number);

  const scene::Scene& scene_;
  std::vector<uint32_t> words_;
  std::map<int, uint32_t> texels_;  ///< first word of each image's
};

}  // namespace limn::rays
