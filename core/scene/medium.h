// The participating medium of a scene as the frame's uniform block holds it.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "glsl/blocks.glsl"

namespace limn::scene {

/// Writes the medium's members of `frame`. The medium fills the bounding sphere of `bounds` (Pose::bounds),
/// of a grid or smoke the part in it; without geometry there is none.
LIMN_API void setMedium(glsl::FrameBlock& frame, const Medium& medium, const Bounds& bounds);

/// What the block says.
inline glsl::Medium mediumOf(const glsl::FrameBlock& frame) {
  return glsl::frame_medium(frame.medium_extinction, frame.medium_scattering, frame.medium_ball);
}

}  // namespace limn::scene
