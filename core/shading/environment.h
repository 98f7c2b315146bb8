// Declares an environment filtered for shading: its cosine convolution, and its radiance blurred by glossy
// lobes.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/base/export.h"
#include "core/gpu/objects.h"
#include "core/scene/scene.h"

namespace limn::shading {

/// Holds linear RGB texels of an equirectangular map, rows from the top, in the frame of the environment that
/// it came from (its rotation and scale are not applied).
struct FilteredMap {
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;

  /// Returns the value in `direction`, which is in the map's frame and of any length except 0: bilinear
  /// between texel centres, wrapped around the seam, clamped at the poles.
  LIMN_API glm::vec3 sample(const glm::vec3& direction) const;
};

/// Returns the map's value at (u, v): bilinear between texel centres, which lie half a step inside the edges,
/// wrapped around the seam, clamped at the poles.
LIMN_API glm::vec3 bilinear(const FilteredMap& map, glm::vec2 uv);

/// Holds what glsl/light/environment.glsl looks up.
struct FilteredEnvironment {
  FilteredMap irradiance;             ///< W/m^2, glsl::environment_irradiance_width wide
  std::vector<FilteredMap> radiance;  ///< glsl::environment_levels levels of growing roughness

  /// Returns the trilinearly filtered value, as the GPU computes it; `alpha` is the GGX width.
  LIMN_API glm::vec3 filtered(const glm::vec3& direction, float alpha) const;
};

/// Returns the filtered maps of an environment. Irradiance is summed over all texels of the map at 128 x 64
/// (in double precision, exact solid angles; error 3e-4); glossy levels use 64 to 1024 samples of the lobe at
/// normal incidence from a mip chain (Krivanek and Colbert 2008, Real-Time Shading with Filtered Importance
/// Sampling). Bright pixels keep their light within 0.3 % on each axis in maps of any size, and whole where
/// sides divide 512 x 256 texels or are larger. Takes a third of a second of one core, up to twice as much
/// where they do not divide them. Throws Error without a map.
LIMN_API FilteredEnvironment filterEnvironment(const scene::Environment& environment);

/// Returns the part of the irradiance that grazes: of light weighted by (1 - n.l)^5, which smooth coats
/// reflect (glsl/light/coated_environment.glsl). A map of the same size, summed likewise. Throws Error
/// without a map.
LIMN_API FilteredMap filterGrazing(const scene::Environment& environment);

/// Return the same, which the process keeps for the last maps that it was asked for, known by their texels.
/// May be called by several threads at once.
LIMN_API std::shared_ptr<const FilteredEnvironment> keptEnvironment(const scene::Environment& environment);
LIMN_API std::shared_ptr<const FilteredMap> keptGrazing(const scene::Environment& environment);

/// Returns the levels above a map itself, each half as large in both directions (rounded down, at least 1),
/// up to one texel: mean radiance over each texel of the level before, weighted by the exact solid angle, so
/// that every level holds the same light. Throws Error without a map.
LIMN_API std::vector<FilteredMap> radianceLevels(const scene::Environment& environment);

/// Returns the texture of such a map: RGBA32F, bilinear, repeated around the horizon;
/// "environment_irradiance" in glsl/light/environment.glsl, "environment_grazing" in
/// glsl/light/reflected_environment.glsl.
LIMN_API gpu::Texture makeIrradianceTexture(gpu::Device& device, const FilteredMap& irradiance);
/// Returns the texture of glossy levels: RGBA16F, bilinear, one level per roughness; "environment_filtered"
/// in glsl/light/environment.glsl, which says what alpha holds.
LIMN_API gpu::Texture makeFilteredTexture(gpu::Device& device, const FilteredEnvironment& environment);
/// Returns the texture of the map and its radianceLevels(): RGB32F, trilinear, repeated around the horizon;
/// "environment_levels_map" in glsl/light/radiance_levels.glsl. Throws Error without a map.
LIMN_API gpu::Texture makeRadianceTexture(gpu::Device& device, const scene::Environment& environment);

}  // namespace limn::shading
