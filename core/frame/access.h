// What each kind of access means to the planner.
#pragma once

#include "core/context/gl_functions.h"
#include "core/frame/frame_graph.h"

namespace limn::frame {

bool isWrite(Access access);
/// Reads the contents it changes.
bool isReadModifyWrite(Access access);
/// A write by a shader to an image or a storage block: later accesses see it only after a barrier.
bool isShaderWrite(Access access);
bool fitsTexture(Access access);
bool fitsBuffer(Access access);
/// The glMemoryBarrier bit that makes earlier shader writes visible to this access (OpenGL 4.5 core, 7.13.2).
GLbitfield barrierBit(Access access, bool texture);

}  // namespace limn::frame
