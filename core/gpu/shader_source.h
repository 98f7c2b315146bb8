// Text of a shader file compiled into a binary by cmake/embed.py.
#pragma once

#include <span>

#include "core/base/export.h"

namespace limn::gpu {

struct EmbeddedSource {
  const char* path;  ///< relative to its root: "glsl/brdf.glsl" in core, "filter.comp.glsl" in a technique
  const char* text;
};

}  // namespace limn::gpu

namespace limn {
/// The files under glsl/, embedded in liblimn.
LIMN_API std::span<const gpu::EmbeddedSource> embeddedSources();
}  // namespace limn
