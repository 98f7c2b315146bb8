// Samples of lights in batches: what their maps take, against what was asked for.
#include "core/shadow/sample_batches.h"

#include <gtest/gtest.h>

namespace limn::shadow {
namespace {

constexpr int64_t kMebibyte = int64_t{1} << 20;

/// Layers of the largest batch.
int64_t most(const std::vector<SampleBatch>& batches, const SampleLayers& layers) {
  int64_t held = 0;
  int next = 0;
  for (const SampleBatch& batch : batches) {
    EXPECT_EQ(batch.first, next);
    next += batch.count;
    held = std::max(held, layers.shared + batch.count * layers.each);
  }
  EXPECT_EQ(next, batches.front().total);
  return held;
}

TEST(SampleBatches, MapsOfABatchTakeNoMoreThanTheMemoryAskedFor) {
  // Two depths of four bytes for each texel.
  for (const int64_t each : {1, 5, 6, 10}) {
    const SampleLayers layers{.each = each, .shared = 6, .size = 512};
    for (const int mebibytes : {64, 256})
      EXPECT_LE(most(sampleBatches(64, layers, mebibytes), layers) * 512 * 512 * 8, mebibytes * kMebibyte);
  }
}

TEST(SampleBatches, MapsOfABatchTakeNoMoreLayersThanATextureHas) {
  // GL_MAX_ARRAY_TEXTURE_LAYERS is 2048 at least (OpenGL 4.5, table 23.54).
  const SampleLayers hemicube{.each = 5, .size = 64};
  EXPECT_LE(most(sampleBatches(1024, hemicube, 1024), hemicube), 2048);
}

TEST(SampleBatches, BatchesHaveNoMoreSamplesThanALoopMayTake) {
  const SampleLayers one{.each = 1, .size = 16};
  EXPECT_EQ(most(sampleBatches(4096, one, 4096), one), 2048);
  EXPECT_LE(most(sampleBatches(4096, one, 4096, 454), one), 454);
}

TEST(SampleBatches, OneSampleIsHeldHoweverLittleMemoryThereIs) {
  EXPECT_EQ(sampleBatches(3, {.each = 6, .size = 4096}, 1).size(), 3u);
}

TEST(SampleBatches, SamplesWithoutMapsAreOneBatch) {
  // Lights without extent: the maps that all samples share would be drawn again for each further batch.
  EXPECT_EQ(sampleBatches(1024, {.each = 0, .shared = 6, .size = 512}, 256).size(), 1u);
  EXPECT_EQ(sampleBatches(1024, {.each = 0, .shared = 6, .size = 4096}, 1).size(), 1u);
}

}  // namespace
}  // namespace limn::shadow
