#include "core/scene/diffusion_profile.h"

#include <algorithm>
#include <cmath>

#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
#include "glsl/numeric/srgb.glsl"

namespace limn::scene {
namespace {

/// Says whether two translucent materials spread light alike.
bool scatterAlike(const Material& a, const Material& b) {
  const Subsurface &s = *a.subsurface, &t = *b.subsurface;
  return a.ior == b.ior && s.extinction == t.extinction && s.absorption == t.absorption &&
         s.albedoFromBaseColour == t.albedoFromBaseColour &&
         (!s.albedoFromBaseColour || a.baseColourTexture.image == b.baseColourTexture.image);
}

/// Returns the mean albedo of a material whose base colour is its albedo, without vertex colours.
glm::vec3 meanAlbedo(const Scene& scene, const Material& material) {
  glm::vec3 albedo = glm::clamp(glm::vec3(material.baseColour), 0.f, 1.f);
  if (material.baseColourTexture.image == kNone) return albedo;
  const TextureImage& image = scene.images[static_cast<size_t>(material.baseColourTexture.image)];
  const std::vector<uint8_t>& texel = image.levels.back().rgba;  // one, the mean of all
  for (int c = 0; c < 3; ++c) {
    const float stored = static_cast<float>(texel[static_cast<size_t>(c)]) / 255;
    albedo[c] *= image.srgb ? glsl::srgb_decode(stored) : stored;
  }
  return albedo;
}

TranslucentKind kindOf(const Scene& scene, const Material& material) {
  const Subsurface& s = *material.subsurface;
  TranslucentKind kind{.extinction = s.extinction,
                       .absorption = s.absorption,
                       .ior = std::clamp(material.ior, 1.f, 3.f),
                       .textured = s.albedoFromBaseColour};
  if (kind.textured) {
    kind.albedo = meanAlbedo(scene, material);
    kind.absorption =
        glsl::walk_absorption(glsl::walk_reflectance(glsl::diffusion_boundary(kind.ior)), kind.albedo);
  }
  return kind;
}

}  // namespace

Profile diffusionProfile(const glm::vec3& extinction, const glm::vec3& absorption, float ior,
                         bool normalised) {
  const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(ior);
  Profile result;
  for (int c = 0; c < 3; ++c) {
    ChannelProfile& channel = result[static_cast<size_t>(c)];
    const auto inMeanFreePaths = [scale = static_cast<double>(extinction[c])](double metres) {
      return static_cast<float>(std::min(metres * scale, 1e10));
    };
    if (normalised) {
      const glsl::NormalisedDiffusion profile =
          glsl::normalised_diffusion(absorption[c], glsl::walk_reflectance(boundary));
      channel.reflectance = static_cast<double>(profile.reflectance);
      channel.share = [=](double radius) {
        return static_cast<double>(glsl::normalised_diffusion_share(profile, inMeanFreePaths(radius)));
      };
    } else {
      const glsl::DiffusionDipole profile = glsl::diffusion_dipole(absorption[c], boundary);
      channel.reflectance = static_cast<double>(profile.reflectance);
      channel.share = [=](double radius) {
        return static_cast<double>(glsl::diffusion_dipole_share(profile, inMeanFreePaths(radius)));
      };
    }
  }
  return result;
}

double leastDistance(const std::function<bool(double)>& holds) {
  double low = std::log(1e-15), high = std::log(1e12);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(std::exp(middle)) ? high : low) = middle;
  }
  return std::exp(high);
}

TranslucentKinds translucentKinds(const Scene& scene) {
  TranslucentKinds result;
  std::vector<const Material*> kept;  // of each kind
  for (const Material& material : scene.materials) {
    uint32_t& kind = result.ofMaterials.emplace_back(~0u);
    if (!material.subsurface) continue;
    const auto same =
        std::ranges::find_if(kept, [&](const Material* other) { return scatterAlike(material, *other); });
    kind = static_cast<uint32_t>(same - kept.begin());
    if (same != kept.end()) continue;
    kept.push_back(&material);
    result.kinds.push_back(kindOf(scene, material));
    result.textured = result.textured || result.kinds.back().textured;
  }
  return result;
}

}  // namespace limn::scene
