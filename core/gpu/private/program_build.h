// Declares how expanded GLSL is compiled and linked.
#pragma once

#include <span>
#include <string>

#include "core/gpu/device.h"
#include "core/gpu/private/glsl_preprocessor.h"

namespace limn::gpu {

struct ShaderStage {
  std::string file;  ///< its name says which stage: .vert.glsl, .geom.glsl, .frag.glsl or .comp.glsl
  ExpandedSource source;
};

/// Returns the name of the linked program, which the caller owns. Throws Error with one line that gives the
/// original file and line of the diagnostics; `label` names the program in it. In a debug context of a
/// software renderer a warning about a limn file is an error.
GLuint linkProgram(Device& device, const std::string& label, std::span<const ShaderStage> stages);

}  // namespace limn::gpu
