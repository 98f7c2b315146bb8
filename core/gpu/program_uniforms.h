// Declares how tools read the plain uniforms of a program; passes only write them.
#pragma once

#include <string>
#include <vector>

#include "core/gpu/objects.h"

namespace limn::gpu {

/// Holds a plain uniform, or one element of an array of them, and what was last set.
struct UniformValue {
  std::string name;   ///< "bias", "light_indices[3]"
  std::string type;   ///< as in GLSL: "float", "uvec2"; the number of OpenGL's enumerant for types that limn
                      ///< does not use
  std::string value;  ///< as a constructor of that type would take it: "0.5", "3, 1"; "" for such types
};

/// Returns the plain uniforms of a program, sorted by name and index. Samplers and images are not among them
/// (Program::resources()). Waits for the driver; never to be used on the frame path.
LIMN_API std::vector<UniformValue> uniformValues(Program& program);

}  // namespace limn::gpu
