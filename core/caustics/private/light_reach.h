// Says which lights need no caustic rays, since none of their light comes to a specular object. No OpenGL.
#pragma once

#include <span>

#include "core/base/export.h"
#include "core/gpu_scene/gpu_scene.h"
#include "glsl/scene/light.glsl"

namespace limn::caustics {

/// Returns whether the light may send anything to what lies in one of the boxes, by its cone, its range and
/// the side that it shines to; what hides it does not count. A box counts as the sphere around it, with room
/// for rounding, so that the answer may be true where nothing arrives, and never false where something does.
LIMN_API bool mayReach(const glsl::Light& light, std::span<const scene::Bounds> boxes);

}  // namespace limn::caustics
