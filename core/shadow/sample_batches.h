// Lights as many samples with a shadow map each: samples go through the frame in batches that share memory.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/gpu/objects.h"
#include "core/technique/parameters.h"
#include "glsl/sampling.glsl"

namespace limn::shadow {

/// Samples first .. first + count - 1 of `total`.
struct SampleBatch {
  int first = 0, count = 0, total = 0;
};

constexpr Parameter memoryParameter() {
  return integer("memory", 256, {1, 4096}, "MiB",
                 "Shadow maps held at once; more samples are rendered in batches");
}

/// What the maps of a batch take.
struct SampleLayers {
  int64_t each = 0;    ///< layers of every sample
  int64_t shared = 0;  ///< layers that every batch has besides
  int size = 0;        ///< texels per side of each layer
};

/// Splits samples into batches (of one sample at least) whose maps take at most `mebibytes`, and no more
/// layers than every device has in one texture.
LIMN_API std::vector<SampleBatch> sampleBatches(int total, const SampleLayers& layers, int mebibytes);

/// Where sample i lies in the unit square: the R2 sequence, shifted so that the first is the centre.
inline glm::vec2 samplePlace(int i) {
  return glm::fract(glsl::r2_sequence(static_cast<uint32_t>(i)) + 0.5f);
}

/// Sets the uniforms of glsl/shadow_samples.glsl.
LIMN_API void setBatch(gpu::Program& program, const SampleBatch& batch);

}  // namespace limn::shadow
