// Declares how passes go through lights: in batches, whose indices a shader knows as
// light_indices[LIGHT_COUNT].
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/gpu/objects.h"

namespace limn {

/// Limits the lights whose visibility, or relief, is held at once (layers of its texture).
inline constexpr std::size_t kLightBatch = 8;

/// Sets `uniform uint light_indices[LIGHT_COUNT]` of a bound program to a batch of at most kLightBatch
/// lights.
inline void setLightIndices(gpu::Program& program, std::span<const std::uint32_t> lights) {
  constexpr std::array<const char*, kLightBatch> names{
      "light_indices[0]", "light_indices[1]", "light_indices[2]", "light_indices[3]",
      "light_indices[4]", "light_indices[5]", "light_indices[6]", "light_indices[7]"};
  for (std::size_t i = 0; i < lights.size(); ++i) program.set(names.at(i), lights[i]);
}

}  // namespace limn
