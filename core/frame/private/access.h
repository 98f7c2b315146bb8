// Declares what each kind of access means to the planner.
#pragma once

#include "core/context/gl_functions.h"
#include "core/frame/frame_graph.h"

namespace limn::frame {

bool isWrite(Access access);
/// Says whether the access reads the contents it changes.
bool isReadModifyWrite(Access access);
/// Says whether a shader writes to an image or a storage block, so that later accesses see it only after a
/// barrier.
bool isShaderWrite(Access access);
/// Says whether a shader accesses the resource by the name of a sampler, an image or a block.
bool isShaderAccess(Access access);
bool fitsTexture(Access access);
bool fitsBuffer(Access access);
/// Returns the glMemoryBarrier bit that makes earlier shader writes visible to this access (OpenGL 4.5 core,
/// 7.13.2).
GLbitfield barrierBit(Access access, bool texture);

}  // namespace limn::frame
