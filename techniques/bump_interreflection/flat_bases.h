// Declares which draw instances of a scene are flat surfaces under a height map.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "techniques/bump_interreflection/flat_base.glsl"

namespace limn::bump_interreflection {

struct FlatBases {
  std::vector<glsl::FlatBase> bases;
  std::vector<uint32_t> ofInstances;  ///< for each instance the index of its base, or no_instance
  size_t texels = 0;                  ///< of the height maps of all bases
  bool curved = false;                ///< instances with a height map are left that are not flat
};

/// Returns the instances of the pose whose material has a height map and all of whose vertices lie in one
/// plane, with one normal and one tangent, and are neither deformed nor a source's.
FlatBases flatBases(const scene::Scene& scene, const scene::Pose& pose);

}  // namespace limn::bump_interreflection
