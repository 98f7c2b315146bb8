#include "core/scene/diffusion_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/image/byte_values.h"
#include "core/scene/draw_instance.h"
#include "core/scene/subsurface.h"
#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"

namespace limn::scene {
namespace {

/// Says whether two translucent materials spread light alike.
bool scatterAlike(const Material& a, const Material& b) {
  const Subsurface &s = *a.subsurface, &t = *b.subsurface;
  return a.ior == b.ior && s.extinction == t.extinction && s.absorption == t.absorption &&
         s.albedoFromBaseColour == t.albedoFromBaseColour &&
         (!s.albedoFromBaseColour || a.baseColourTexture.image == b.baseColourTexture.image);
}

/// Says what the primitives that are drawn with a material make of its albedo.
struct DrawnAlbedo {
  glm::vec3 vertexColour{1};  ///< the mean of their vertices, where it is a factor on the albedo, else 1
  bool varies = false;        ///< albedoVaries() of at least one
  bool operator==(const DrawnAlbedo&) const = default;
};

/// Returns it for each material.
std::vector<DrawnAlbedo> drawnAlbedos(const Scene& scene, const Pose& pose) {
  std::vector<DrawnAlbedo> result(scene.materials.size());
  std::vector<glm::dvec3> sums(scene.materials.size(), glm::dvec3(0));
  std::vector<double> counts(scene.materials.size(), 0.0);
  for (const DrawInstance& instance : pose.instances) {
    const auto index = static_cast<size_t>(materialIndexOf(scene, instance));
    const Material& material = scene.materials[index];
    if (!material.subsurface || !material.subsurface->albedoFromBaseColour) continue;
    const Primitive& primitive = primitiveOf(scene, pose, instance);
    result[index].varies = result[index].varies || albedoVaries(material, primitive);
    const auto vertices = static_cast<double>(primitive.positions.size());
    counts[index] += vertices;
    if (primitive.colours.empty()) sums[index] += glm::dvec3(vertices);
    for (const glm::vec4& colour : primitive.colours) sums[index] += glm::dvec3(colour);
  }
  for (size_t i = 0; i < result.size(); ++i)
    if (counts[i] > 0) result[i].vertexColour = glm::vec3(sums[i] / counts[i]);
  return result;
}

TranslucentKind kindOf(const Scene& scene, const Material& material, const DrawnAlbedo& drawn) {
  const Subsurface& s = *material.subsurface;
  TranslucentKind kind{.extinction = s.extinction,
                       .absorption = s.absorption,
                       .ior = subsurfaceIor(material.ior),
                       .textured = drawn.varies};
  if (s.albedoFromBaseColour) {
    kind.albedo = drawn.vertexColour * baseAlbedo(scene, material, OfTexels::mean);
    kind.absorption = subsurfaceAbsorption(kind.albedo, kind.ior);
  }
  return kind;
}

}  // namespace

bool albedoVaries(const Material& material, const Primitive& primitive) {
  return material.subsurface && material.subsurface->albedoFromBaseColour &&
         (material.baseColourTexture.image != kNone || !primitive.colours.empty());
}

glm::vec3 baseAlbedo(const Scene& scene, const Material& material, OfTexels which) {
  glm::vec3 albedo(material.baseColour);
  const int index = material.baseColourTexture.image;
  if (index != kNone && !scene.images[static_cast<size_t>(index)].levels.empty()) {
    const TextureImage& image = scene.images[static_cast<size_t>(index)];
    // The last level is a single texel, the mean of all.
    const std::vector<uint8_t>& texels =
        (which == OfTexels::mean ? image.levels.back() : image.levels.front()).rgba;
    std::array<uint8_t, 3> most{};
    for (size_t i = 0; i + 3 < texels.size(); i += 4)
      for (size_t c = 0; c < 3; ++c) most[c] = std::max(most[c], texels[i + c]);
    const auto& values = byteValues(image.srgb);
    albedo *= glm::vec3(values[most[0]], values[most[1]], values[most[2]]);
  }
  return glm::clamp(albedo, 0.f, 1.f);
}

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

TranslucentKinds translucentKinds(const Scene& scene, const Pose& pose) {
  std::vector<bool> drawn(scene.materials.size());
  for (const DrawInstance& instance : pose.instances)
    drawn[static_cast<size_t>(materialIndexOf(scene, instance))] = true;
  TranslucentKinds result;
  const std::vector<DrawnAlbedo> albedos = drawnAlbedos(scene, pose);
  std::vector<size_t> kept;  // a material of each kind
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    uint32_t& kind = result.ofMaterials.emplace_back(~0u);
    if (!drawn[i] || !material.subsurface) continue;
    const auto same = std::ranges::find_if(kept, [&](size_t other) {
      return scatterAlike(material, scene.materials[other]) && albedos[i] == albedos[other];
    });
    kind = static_cast<uint32_t>(same - kept.begin());
    if (same != kept.end()) continue;
    kept.push_back(i);
    result.kinds.push_back(kindOf(scene, material, albedos[i]));
    result.textured = result.textured || result.kinds.back().textured;
  }
  return result;
}

}  // namespace limn::scene
