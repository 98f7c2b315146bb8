// Declares how the bound of a technique is found: docs/bench.md says what it is.
#pragma once

#include <algorithm>
#include <string_view>

#include "core/technique/technique.h"

namespace limn {

/// Names the shader in a technique's folder that is the bound of its visibility.comp.glsl.
inline constexpr std::string_view kBoundFile = "bound.comp.glsl";
/// Names the pass that runs it.
inline constexpr std::string_view kBoundPass = "bound";

/// Returns whether the technique brings a bound.
inline bool hasBound(const TechniquePlugin& plugin) {
  return std::ranges::any_of(plugin.sources(), [](const gpu::EmbeddedSource& source) {
    return std::string_view(source.path) == kBoundFile;
  });
}

}  // namespace limn
