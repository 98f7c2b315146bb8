// Declares how a scene's participating medium is written to and read from the frame's uniform block.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "glsl/scene/blocks.glsl"

namespace limn::scene {

/// Writes the medium's members of `frame`. The medium fills the bounding sphere of `bounds` (Pose::bounds); a
/// grid or smoke fills the part of its box that lies in the sphere. Without geometry there is no medium.
LIMN_API void setMedium(glsl::FrameBlock& frame, const Medium& medium, const Bounds& bounds);

/// Returns the medium that the block holds.
inline glsl::Medium mediumOf(const glsl::FrameBlock& frame) {
  return glsl::frame_medium(frame.medium_extinction, frame.medium_scattering, frame.medium_asymmetry,
                            frame.medium_ball);
}

}  // namespace limn::scene
