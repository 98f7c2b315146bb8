// An environment filtered for shading: its cosine convolution and its radiance blurred by glossy lobes.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/gpu/objects.h"
#include "core/scene/scene.h"

namespace limn::shading {

/// Linear RGB texels of an equirectangular map, rows from the top, in the frame of the environment that it
/// came from (its rotation and scale are not applied).
struct FilteredMap {
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;

  /// Bilinear between texel centres, around the seam, clamped at the poles; `direction` in the map's frame,
  /// any length but 0.
  LIMN_API glm::vec3 sample(const glm::vec3& direction) const;
};

/// The map at (u, v): bilinear between texel centres half a step inside the edges, around the seam, clamped
/// at the poles.
LIMN_API glm::vec3 bilinear(const FilteredMap& map, glm::vec2 uv);

/// What glsl/environment.glsl looks up.
struct FilteredEnvironment {
  FilteredMap irradiance;             ///< W/m^2, glsl::environment_irradiance_width wide
  std::vector<FilteredMap> radiance;  ///< glsl::environment_levels levels of growing roughness

  /// Trilinear, as the GPU does it; alpha: GGX width.
  LIMN_API glm::vec3 filtered(const glm::vec3& direction, float alpha) const;
};

/// Irradiance is summed over all texels of the map at 128 x 64 (in double precision, exact solid angles;
/// error 3e-4); glossy levels by 64 to 1024 samples of the lobe at normal incidence from a mip chain
/// (Krivanek and Colbert 2008, Real-Time Shading with Filtered Importance Sampling). Takes a third of a
/// second of one core. Throws Error without a map.
LIMN_API FilteredEnvironment filterEnvironment(const scene::Environment& environment);

/// RGBA32F, bilinear, repeated around the horizon; for unit glsl::environment_unit_irradiance.
LIMN_API gpu::Texture makeIrradianceTexture(gpu::Device& device, const FilteredEnvironment& environment);
/// RGBA16F, bilinear, one level per roughness; for unit glsl::environment_unit_filtered.
LIMN_API gpu::Texture makeFilteredTexture(gpu::Device& device, const FilteredEnvironment& environment);

}  // namespace limn::shading
