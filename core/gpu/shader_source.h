// Declares the text of shader files that cmake/embed.py compiles into a binary.
#pragma once

#include <span>

#include "core/base/export.h"

namespace limn::gpu {

struct EmbeddedSource {
  const char*
      path;  ///< relative to its root: "glsl/surface/brdf.glsl" in core, "filter.comp.glsl" in a technique
  const char* text;
};

}  // namespace limn::gpu

namespace limn {
/// Returns the files under glsl/, which are embedded in liblimn.
LIMN_API std::span<const gpu::EmbeddedSource> embeddedSources();
}  // namespace limn
