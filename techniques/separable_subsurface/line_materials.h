// Declares the taps of the translucent materials that a scene draws.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "techniques/separable_subsurface/line_tap.glsl"

namespace limn::separable_subsurface {

struct LineSettings {
  bool normalised;   ///< normalised diffusion in place of the dipole
  int taps;          ///< along a line
  float depthLimit;  ///< over the radius within which half of the widest channel's light leaves
};

/// Holds the taps of materials that scatter alike only once.
struct LineMaterials {
  std::vector<glsl::LineMaterial> materials;
  std::vector<glsl::LineTap> taps;
  std::vector<uint32_t>
      rows;               ///< of each material of the scene, in `materials`; ~0: it is opaque or not drawn
  bool textured = false;  ///< at least one has its pixels' albedo
};

LineMaterials lineMaterials(const scene::Scene& scene, const scene::Pose& pose, const LineSettings& settings);

}  // namespace limn::separable_subsurface
