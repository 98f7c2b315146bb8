// Declares what the implementations of the GPU objects share.
#pragma once

#include <string_view>

#include "core/gpu/device.h"

namespace limn::gpu {

/// Says whether the driver ran out of memory since the last OpenGL error was read. Reads all pending errors:
/// in a debug context they have already been reported through KHR_debug.
inline bool outOfMemory(const gl::Functions& gl) {
  bool found = false;
  for (GLenum error = gl.GetError(); error != GL_NO_ERROR; error = gl.GetError())
    found |= error == GL_OUT_OF_MEMORY;
  return found;
}

}  // namespace limn::gpu
