// Alpha masks as words: what shaders look up is what the scene holds.
#include "core/rays/coverage.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>

#include "glsl/rays/ray_coverage.glsl"
#include "glsl/rays/ray_node.glsl"
#include "tests/support/test_scenes.h"

namespace limn::rays {
namespace {

float asFloat(uint32_t word) {
  return std::bit_cast<float>(word);
}

TEST(CoverageTest, OpaqueMaterialsHaveNone) {
  const scene::Scene scene;
  CoverageTable table(scene);
  const std::array<uint32_t, 2> order{0, 1};
  EXPECT_EQ(table.add(test::floorPrimitive(1, 0), {}, order), glsl::ray_opaque);
  EXPECT_TRUE(table.words().empty());
}

TEST(CoverageTest, HoldsCornersInTheOrderOfLeavesAndTexelsOnce) {
  scene::Scene scene;
  scene::TextureImage image;
  image.levels.push_back({3, 2, {}});
  for (uint8_t i = 0; i < 6; ++i) image.levels[0].rgba.insert(image.levels[0].rgba.end(), {9, 9, 9, i});
  scene.images.push_back(image);
  scene::Material material;
  material.baseColour.a = 0.75f;
  material.alphaCutoff = 0.5f;
  material.baseColourTexture = {0, scene::Wrap::mirror, scene::Wrap::clamp};
  scene::Primitive primitive = test::floorPrimitive(1, 0);
  primitive.colours = {{1, 1, 1, 0.25f}, {1, 1, 1, 0.5f}, {1, 1, 1, 1}, {1, 1, 1, 0}};
  CoverageTable table(scene);
  const std::array<uint32_t, 2> order{1, 0};
  const uint32_t first = table.add(primitive, material, order);
  const size_t words = table.words().size();
  const uint32_t second = table.add(primitive, material, order);
  const std::vector<uint32_t>& w = table.words();
  EXPECT_EQ(w.size() - words, glsl::ray_mask_words + 2 * glsl::ray_corner_words);
  EXPECT_EQ(w[first + glsl::ray_mask_texels], w[second + glsl::ray_mask_texels]);
  EXPECT_EQ(w[first + glsl::ray_mask_width], 3u);
  EXPECT_EQ(w[first + glsl::ray_mask_height], 2u);
  EXPECT_EQ(w[first + glsl::ray_mask_wraps], glsl::ray_wrap_mirror | glsl::ray_wrap_clamp << 2);
  EXPECT_EQ(asFloat(w[first + glsl::ray_mask_factor]), 0.75f);
  EXPECT_EQ(asFloat(w[first + glsl::ray_mask_cutoff]), 0.5f);
  for (uint32_t i = 0; i < 6; ++i)
    EXPECT_EQ(w[w[first + glsl::ray_mask_texels] + i / 4] >> 8 * (i % 4) & 255u, i);
  for (uint32_t place = 0; place < 2; ++place) {
    const uint32_t at = w[second + glsl::ray_mask_corners] + place * glsl::ray_corner_words;
    const glm::vec2 low = glm::unpackHalf2x16(w[at + 6]), high = glm::unpackHalf2x16(w[at + 7]);
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t vertex = primitive.indices[3 * order[place] + k];
      EXPECT_EQ(glm::vec2(asFloat(w[at + 2 * k]), asFloat(w[at + 2 * k + 1])), primitive.uvs[vertex]);
      EXPECT_EQ(k < 2 ? low[static_cast<int>(k)] : high.x, primitive.colours[vertex].a);
    }
  }
}

TEST(CoverageTest, TexturesGoOnAsTheySay) {
  for (const auto& [wrap, expected] : {std::pair(glsl::ray_wrap_repeat, std::array{1, 2, 0, 1, 2, 0}),
                                       std::pair(glsl::ray_wrap_clamp, std::array{0, 0, 0, 1, 2, 2}),
                                       std::pair(glsl::ray_wrap_mirror, std::array{1, 0, 0, 1, 2, 2})})
    for (int i = -2; i < 4; ++i)
      EXPECT_EQ(glsl::ray_wrap(i, 3, wrap), expected[static_cast<size_t>(i + 2)]) << wrap << " at " << i;
  EXPECT_FLOAT_EQ(glsl::ray_wrap_near(-0.25f, glsl::ray_wrap_repeat), 0.75f);
  EXPECT_FLOAT_EQ(glsl::ray_wrap_near(3.25f, glsl::ray_wrap_mirror), 1.25f);
  EXPECT_FLOAT_EQ(glsl::ray_wrap_near(7.f, glsl::ray_wrap_clamp), 2.f);
}

}  // namespace
}  // namespace limn::rays
