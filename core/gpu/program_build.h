// Compiles and links expanded GLSL.
#pragma once

#include <span>
#include <string>

#include "core/gpu/device.h"
#include "core/gpu/glsl_preprocessor.h"

namespace limn::gpu {

struct ShaderStage {
  std::string file;  ///< its name says which stage: .vert.glsl, .geom.glsl, .frag.glsl or .comp.glsl
  ExpandedSource source;
};

/// The linked program's name, which the caller owns. Throws Error in one line with the original file and line
/// of the diagnostics; `label` says which program. In a debug context a warning about a limn file is an
/// error.
GLuint linkProgram(Device& device, const std::string& label, std::span<const ShaderStage> stages);

}  // namespace limn::gpu
