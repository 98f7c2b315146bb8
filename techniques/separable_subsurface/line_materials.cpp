#include "techniques/separable_subsurface/line_materials.h"

#include <algorithm>
#include <tuple>

#include "techniques/separable_subsurface/line_kernel.h"

namespace limn::separable_subsurface {
namespace {

/// Says whether two translucent materials spread light alike.
bool alike(const scene::Material& a, const scene::Material& b) {
  const scene::Subsurface &s = *a.subsurface, &t = *b.subsurface;
  return a.ior == b.ior && s.extinction == t.extinction && s.absorption == t.absorption &&
         s.albedoFromBaseColour == t.albedoFromBaseColour;
}

}  // namespace

LineMaterials lineMaterials(const scene::Scene& scene, const LineSettings& settings) {
  LineMaterials result;
  std::vector<const scene::Material*> kept;  // of each row
  for (const scene::Material& material : scene.materials) {
    uint32_t& row = result.rows.emplace_back(~0u);
    if (!material.subsurface) continue;
    const auto same =
        std::ranges::find_if(kept, [&](const scene::Material* other) { return alike(material, *other); });
    row = static_cast<uint32_t>(same - kept.begin());
    if (same != kept.end()) continue;
    kept.push_back(&material);
    const scene::Subsurface& s = *material.subsurface;
    const float ior = std::clamp(material.ior, 1.f, 3.f);
    const LineKernel kernel =
        lineKernel(profileOf(s.extinction, s.absorption, ior, settings.normalised), settings.taps);
    result.materials.push_back({.reflectance = kernel.reflectance,
                                .eta = ior,
                                .entering = glsl::diffusion_boundary(ior).entering,
                                .depth_limit = std::max(settings.depthLimit * kernel.halfRadius, 1e-30f),
                                .first_tap = static_cast<uint32_t>(result.taps.size()),
                                .textured = s.albedoFromBaseColour ? 1u : 0u});
    result.taps.insert(result.taps.end(), kernel.taps.begin(), kernel.taps.end());
    result.textured = result.textured || s.albedoFromBaseColour;
  }
  return result;
}

}  // namespace limn::separable_subsurface
