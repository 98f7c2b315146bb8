#include "techniques/separable_subsurface/line_materials.h"

#include <algorithm>
#include <utility>

#include "core/scene/diffusion_profile.h"
#include "techniques/separable_subsurface/line_kernel.h"
#include "techniques/separable_subsurface/line_width.glsl"

namespace limn::separable_subsurface {

LineMaterials lineMaterials(const scene::Scene& scene, const scene::Pose& pose,
                            const LineSettings& settings) {
  scene::TranslucentKinds kinds = scene::translucentKinds(scene, pose);
  LineMaterials result;
  result.rows = std::move(kinds.ofMaterials);
  result.textured = kinds.textured;
  for (const scene::TranslucentKind& kind : kinds.kinds) {
    const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(kind.ior);
    const LineKernel kernel =
        lineKernel(scene::diffusionProfile(kind.extinction, kind.absorption, kind.ior, settings.normalised),
                   settings.taps);
    result.materials.push_back(
        {.reflectance = kernel.reflectance,
         .eta = kind.ior,
         .extinction = kind.extinction,
         .width = glsl::line_width(kind.albedo, kind.extinction, glsl::walk_reflectance(boundary)),
         .entering = boundary.entering,
         .depth_limit = std::max(settings.depthLimit * kernel.halfRadius, 1e-30f),
         .first_tap = static_cast<uint32_t>(result.taps.size()),
         .textured = kind.textured ? 1u : 0u});
    result.taps.insert(result.taps.end(), kernel.taps.begin(), kernel.taps.end());
  }
  return result;
}

}  // namespace limn::separable_subsurface
