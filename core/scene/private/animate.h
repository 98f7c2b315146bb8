// Declares how animation channels are sampled. Internal to core/scene.
#pragma once

#include <span>

#include "core/scene/scene.h"

namespace limn::scene {

/// Writes the channel's value at `time` (glTF 2.0, appendix C), clamped before the first and after the last
/// key. `out` has one element per component (3; rotation 4, as x y z w, unit; weights: one per target).
void sampleChannel(const AnimationChannel& channel, double time, std::span<float> out);

}  // namespace limn::scene
