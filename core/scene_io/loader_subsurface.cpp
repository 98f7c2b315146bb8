// Translucent materials: extras.limn_subsurface, and the drafts of Khronos that say the same.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/error.h"
#include "core/scene/subsurface.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

constexpr double kLeastExtinction = 1e-6, kMostExtinction = 1e9;  // per metre
constexpr float kMostAnisotropy = 0.999f;

bool absent(const tinygltf::ExtensionMap& map, const char* name) {
  const auto found = map.find(name);
  return found == map.end() || !found->second.IsObject();
}

/// Returns Kulla and Conty's albedo of a single event in a half space that reflects the share `albedo` (2017,
/// Revisiting Physically Based Shading at Imageworks), which the drafts prescribe. The half space reflects
/// that share where events scatter with the mean cosine `anisotropy`.
double singleScattering(double albedo, double anisotropy) {
  const double root = std::sqrt(9.59217 + albedo * (41.6808 + 17.7126 * albedo));
  const double s = 4.09712 + 4.20863 * albedo - root;
  return std::clamp((1 - s * s) / (1 - anisotropy * s * s), 0., 1.);
}

}  // namespace

glm::vec3 Loader::readChannels(const tinygltf::Value& object, const char* key, const std::string& what) {
  const tinygltf::Value& value = object.Get(key);
  const std::string place = fmt::format("{} {}", what, key);
  glm::vec3 result;
  if (value.IsNumber()) {
    result = glm::vec3(number(value.GetNumberAsDouble(), place));
  } else {
    const std::vector<float> rgb = numbers(value, 3, place);
    result = {rgb[0], rgb[1], rgb[2]};
  }
  if (result.x < 0 || result.y < 0 || result.z < 0) fail(place + ": it must not be negative");
  return result;
}

Subsurface Loader::readSubsurface(const tinygltf::Value& extras, const Material& material,
                                  const std::string& what) {
  const bool given = extras.IsObject(), lengths = given && extras.Has("mean_free_path");
  const bool coefficients = given && extras.Has("sigma_a") && extras.Has("sigma_s_prime");
  if (lengths == coefficients || (lengths && (extras.Has("sigma_a") || extras.Has("sigma_s_prime"))))
    fail(what + ": an object {sigma_a, sigma_s_prime} or {mean_free_path} is accepted");
  Subsurface s;
  if (lengths) {
    s.extinction = 1.f / readChannels(extras, "mean_free_path", what);
    s.albedoFromBaseColour = true;
    s.absorption = subsurfaceAbsorption(glm::vec3(material.baseColour), material.ior);
  } else {
    const glm::vec3 absorbed = readChannels(extras, "sigma_a", what);
    s.extinction = absorbed + readChannels(extras, "sigma_s_prime", what);
    s.absorption = absorbed / s.extinction;
  }
  for (int c = 0; c < 3; ++c) {
    if (!(s.extinction[c] >= kLeastExtinction && s.extinction[c] <= kMostExtinction))
      fail(fmt::format(
          "{}: sigma_a + sigma_s_prime (1 / mean_free_path) is {} per metre; {} to {} are accepted", what,
          s.extinction[c], kLeastExtinction, kMostExtinction));
  }
  return s;
}

std::optional<Subsurface> Loader::readScatterDraft(const tinygltf::Material& source, const Material& material,
                                                   const std::string& what) {
  const auto& map = source.extensions;
  const bool newer = !absent(map, "KHR_materials_scatter");
  const char* name = newer ? "KHR_materials_scatter" : "KHR_materials_volume_scatter";
  if (absent(map, name)) return std::nullopt;
  const tinygltf::Value& scatter = map.find(name)->second;
  const std::string place = fmt::format("{} {}", what, name);
  const auto dense = [](float c) { return c > 0 && c < 1; };
  const glm::vec3 attenuation = material.attenuationColour;
  if (!(material.attenuationDistance > 0) || !dense(attenuation.x) || !dense(attenuation.y) ||
      !dense(attenuation.z)) {
    warn(place +
         " is ignored: it needs KHR_materials_volume with an attenuationDistance and an "
         "attenuationColor between 0 and 1");
    return std::nullopt;
  }
  if (material.thickness == 0) {
    warn(place + " is ignored: a thicknessFactor of 0 makes the surface a thin wall");
    return std::nullopt;
  }
  const char* colour = newer ? "multiscatterColorFactor" : "multiscatterColor";
  glm::vec3 albedo(newer ? 1.f : 0.f);
  if (scatter.Has(colour)) albedo = glm::min(readChannels(scatter, colour, place), glm::vec3(1));
  float anisotropy = 0;
  if (scatter.Get("scatterAnisotropy").IsNumber())
    anisotropy = ranged(scatter.Get("scatterAnisotropy").GetNumberAsDouble(), -kMostAnisotropy,
                        kMostAnisotropy, place + " scatterAnisotropy");
  for (const char* key : {"multiscatterColorTexture", "scatterStrengthFactor", "scatterStrengthTexture"})
    if (scatter.Has(key)) warn(fmt::format("{}: {} is ignored", place, key));

  Subsurface s;
  for (int c = 0; c < 3; ++c) {
    const double whole = -std::log(double(attenuation[c])) / material.attenuationDistance;
    // The older draft has the albedo of events not depend on where they scatter to.
    const double scattered = singleScattering(albedo[c], newer ? anisotropy : 0.f);
    const double reduced = 1 - scattered + (1 - anisotropy) * scattered;  // sigma_t' / sigma_t
    s.absorption[c] = static_cast<float>((1 - scattered) / reduced);
    s.extinction[c] = ranged(whole * reduced, kLeastExtinction, kMostExtinction, place + " extinction");
  }
  return s;
}

int Loader::maskOf(int image, const std::string& what) {
  const auto [known, added] = maskIndex_.try_emplace(image, image);
  if (!added) return known->second;
  const auto index = static_cast<std::size_t>(image);
  const auto forColours = [](TextureImage& of, auto&& take) {
    for (TextureImage::Level& level : of.levels)
      for (std::size_t i = 0; i < level.rgba.size(); ++i)
        if (i % 4 != 3) take(level.rgba[i]);
  };
  bool white = true;
  forColours(scene_.images[index], [&](std::uint8_t& value) { white = white && value == 255; });
  if (white) return image;
  const TextureImage::Level& whole = scene_.images[index].levels.front();
  texels_ += static_cast<std::uint64_t>(whole.width) * static_cast<std::uint64_t>(whole.height);
  if (texels_ > limits_.imageTexels)
    fail(fmt::format("{}: more than {} texels in all images", what, limits_.imageTexels));
  TextureImage mask = scene_.images[index];
  forColours(mask, [](std::uint8_t& value) { value = 255; });
  scene_.images.push_back(std::move(mask));
  return known->second = static_cast<int>(scene_.images.size()) - 1;
}

void Loader::applySubsurface(const tinygltf::Material& source, Material& material, const std::string& what) {
  std::optional<Subsurface> s;
  std::string place = what + " limn_subsurface";
  if (source.extras.IsObject() && source.extras.Has("limn_subsurface")) {
    s = readSubsurface(source.extras.Get("limn_subsurface"), material, place);
  } else {
    s = readScatterDraft(source, material, what);
    place = what + " scattering";
  }
  if (!s) return;
  if (material.model) {
    warn(place + ": there is a limn_material too, which is used instead");
    return;
  }
  material.subsurface = s;
  material.metallic = 0;
  material.transmission = 0;
  if (s->albedoFromBaseColour) return;
  if (TextureRef& texture = material.baseColourTexture; texture.image != kNone) {
    const int mask = material.alphaCutoff > 0 ? maskOf(texture.image, place) : kNone;
    if (mask != texture.image)
      warn(place +
           ": the colours of the baseColorTexture have no part in it; mean_free_path takes the "
           "albedo from them");
    if (mask == kNone)
      texture = {};
    else
      texture.image = mask;
  }
  material.baseColour = glm::vec4(subsurfaceAlbedo(s->absorption, material.ior), material.baseColour.a);
}

}  // namespace limn::scene
