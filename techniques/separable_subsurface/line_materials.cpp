#include "techniques/separable_subsurface/line_materials.h"

#include <algorithm>

#include "glsl/numeric/srgb.glsl"
#include "techniques/separable_subsurface/line_kernel.h"
#include "techniques/separable_subsurface/line_width.glsl"

namespace limn::separable_subsurface {
namespace {

/// Says whether two translucent materials spread light alike.
bool alike(const scene::Material& a, const scene::Material& b) {
  const scene::Subsurface &s = *a.subsurface, &t = *b.subsurface;
  return a.ior == b.ior && s.extinction == t.extinction && s.absorption == t.absorption &&
         s.albedoFromBaseColour == t.albedoFromBaseColour &&
         (!s.albedoFromBaseColour || a.baseColourTexture.image == b.baseColourTexture.image);
}

/// Returns the mean albedo of a material whose base colour is its albedo, without vertex colours.
glm::vec3 meanAlbedo(const scene::Scene& scene, const scene::Material& material) {
  glm::vec3 albedo = glm::clamp(glm::vec3(material.baseColour), 0.f, 1.f);
  if (material.baseColourTexture.image == scene::kNone) return albedo;
  const scene::TextureImage& image = scene.images[static_cast<size_t>(material.baseColourTexture.image)];
  const std::vector<uint8_t>& texel = image.levels.back().rgba;  // one, the mean of all
  for (int c = 0; c < 3; ++c) {
    const float stored = static_cast<float>(texel[static_cast<size_t>(c)]) / 255;
    albedo[c] *= image.srgb ? glsl::srgb_decode(stored) : stored;
  }
  return albedo;
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
    const glsl::WalkReflectance walk = glsl::walk_reflectance(glsl::diffusion_boundary(ior));
    glm::vec3 albedo(0), absorption = s.absorption;
    if (s.albedoFromBaseColour) {
      albedo = meanAlbedo(scene, material);
      for (int c = 0; c < 3; ++c) absorption[c] = glsl::walk_absorption(walk, albedo[c]);
    }
    const LineKernel kernel =
        lineKernel(profileOf(s.extinction, absorption, ior, settings.normalised), settings.taps);
    result.materials.push_back({.reflectance = kernel.reflectance,
                                .eta = ior,
                                .extinction = s.extinction,
                                .width = glsl::line_width(albedo, s.extinction, walk),
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
