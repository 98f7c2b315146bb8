// Declares batches of light samples, each sample with its own shadow map: batches go through the frame one
// after another and share memory.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/base/parameters.h"
#include "core/gpu/objects.h"
#include "glsl/numeric/sampling.glsl"

namespace limn {
struct TechniqueInputs;
}

namespace limn::shadow {

struct ShadowMaps;

/// Holds the samples first .. first + count - 1 of `total`.
struct SampleBatch {
  int first = 0, count = 0, total = 0;

  bool isFirst() const { return first == 0; }
  bool isLast() const { return first + count == total; }
  /// Adds SAMPLES_FIRST and SAMPLES_LAST, 1 where no batch is before this one, or after, for programs that
  /// hand sums on from batch to batch.
  LIMN_API void defineOrder(std::map<std::string, std::string>& defines) const;
};

constexpr Parameter memoryParameter() {
  return integer("memory", 256, {1, 4096}, "MiB",
                 "Memory for shadow maps held at once; further samples are rendered in batches");
}

/// Holds the numbers of layers that the maps of a batch take.
struct SampleLayers {
  int64_t each = 0;    ///< layers of every sample
  int64_t shared = 0;  ///< further layers of every batch
  int size = 0;        ///< texels per side of each layer
};

/// Splits samples into batches (of at least one sample and, where samples have maps of their own, at most
/// `largest`) whose maps take at most `mebibytes`, and no more layers than every device supports in one
/// texture.
LIMN_API std::vector<SampleBatch> sampleBatches(int total, const SampleLayers& layers, int mebibytes,
                                                int largest = 4096);

/// Returns how many steps all loops of a thread may take together: llvmpipe leaves them after 65,535. GPUs
/// have no such bound.
LIMN_API int mostStepsOfLoops(const TechniqueInputs& inputs);

/// Returns how many samples one loop of a program may reflect; a pixel has two such loops at most. Light that
/// crosses the grid of a medium takes many steps.
LIMN_API int mostSamplesOfLoop(const TechniqueInputs& inputs);

/// Throws UsageError where a pixel that takes `samples` in each part of a light would leave its loops before
/// it comes to the last part, on software renderers.
LIMN_API void checkSamplesOfParts(const TechniqueInputs& inputs, std::string_view technique,
                                  const ShadowMaps& maps, int samples);

/// Returns the place of sample i in the unit square: the R2 sequence, shifted so that the first is the
/// centre.
inline glm::vec2 samplePlace(int i) {
  return glm::fract(glsl::r2_sequence(static_cast<uint32_t>(i)) + 0.5f);
}

/// Sets the uniforms of glsl/shadow/shadow_samples.glsl.
LIMN_API void setBatch(gpu::Program& program, const SampleBatch& batch);

}  // namespace limn::shadow
