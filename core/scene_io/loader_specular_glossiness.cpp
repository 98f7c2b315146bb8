// KHR_materials_pbrSpecularGlossiness, which glTF has archived, as metallic-roughness: the diffuse colour is
// the base colour of a dielectric whose reflectance at normal incidence is the specular colour, as an index
// of refraction of 0 in KHR_materials_ior allows it, and roughness is 1 - glossiness.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

#include "core/image/byte_values.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {

int Loader::readGlossiness(int index, bool another, float glossiness, glm::vec3& meanSpecular,
                           const std::string& what) {
  const int first = imageAt(index, what).first;
  auto known = glossyImages_.find({first, glossiness});
  if (known == glossyImages_.end()) {
    std::optional<Image8> image = decodeImage(first, another, what);
    if (!image) return kNone;
    const GlossyImage added = addGlossiness(first, glossiness, *std::move(image));
    known = glossyImages_.emplace(std::pair(first, glossiness), added).first;
  }
  if (known->second.varies) warn(what + ": the mean of its specular colours is used");
  meanSpecular = known->second.meanSpecular;
  return known->second.roughness;
}

Loader::GlossyImage Loader::addGlossiness(int index, float glossiness, Image8 image) {
  const glm::u8vec3 first(image.data[0], image.data[1], image.data[2]);
  const auto& colour = byteValues(true);
  glm::dvec3 sum(0);
  GlossyImage result;
  for (std::size_t i = 0; i < image.data.size(); i += 4) {
    std::uint8_t* texel = &image.data[i];
    for (int c = 0; c < 3; ++c) {
      sum[c] += static_cast<double>(colour[texel[c]]);
      result.varies = result.varies || texel[c] != first[c];
    }
    // Roughness stands in the green channel of metallic-roughness, metalness, whose factor is 0, in the blue
    // one.
    const float roughness = 1 - glossiness * static_cast<float>(texel[3]) / 255.f;
    texel[0] = texel[2] = 0;
    texel[1] = static_cast<std::uint8_t>(std::lround(255.f * roughness));
    texel[3] = 255;
  }
  result.meanSpecular = glm::vec3(4.0 / static_cast<double>(image.data.size()) * sum);
  result.roughness = addImage(index, false, std::move(image));
  return result;
}

void Loader::applySpecularGlossiness(const tinygltf::Value& e, Material& m, std::vector<TextureUse>& uses,
                                     const std::string& what) {
  warn(what + ": KHR_materials_pbrSpecularGlossiness is converted to metallic-roughness");
  const auto factor = [&](const char* key, std::size_t count, float* out) {
    if (!e.Has(key)) return;
    const std::string place = fmt::format("{} {}", what, key);
    const std::vector<float> values = numbers(e.Get(key), count, place);
    for (std::size_t i = 0; i < count; ++i) out[i] = ranged(static_cast<double>(values[i]), 0, 1, place);
  };
  m.baseColour = glm::vec4(1);
  m.specularColour = glm::vec3(1);
  factor("diffuseFactor", 4, &m.baseColour.x);
  factor("specularFactor", 3, &m.specularColour.x);
  const tinygltf::Value& gloss = e.Get("glossinessFactor");
  const float glossiness =
      gloss.IsNumber() ? ranged(gloss.GetNumberAsDouble(), 0, 1, what + " glossinessFactor") : 1.f;
  m.metallic = 0;
  m.roughness = 1 - glossiness;
  m.ior = kInfiniteIndex;
  m.specularFactor = 1;
  if (e.Has("diffuseTexture"))
    readTexture(textureInfo(e.Get("diffuseTexture")), true, m.baseColourTexture, uses,
                what + " diffuseTexture");
  if (!e.Has("specularGlossinessTexture")) return;
  const std::string place = what + " specularGlossinessTexture";
  const TextureInfo info = textureInfo(e.Get("specularGlossinessTexture"));
  const tinygltf::Texture& texture = textureAt(info.index, place);
  glm::vec3 mean(1);
  const int image = firstImage(texture, place, [&](int index, bool another) {
    return readGlossiness(index, another, glossiness, mean, place);
  });
  if (image == kNone) return;
  const auto [wrapS, wrapT] = wrapsOf(texture, place);
  m.metalRoughTexture = {image, wrapS, wrapT};
  m.roughness = 1;
  m.specularColour *= mean;
  uses.push_back({&m.metalRoughTexture, uvsOf(info, place), place});
}

}  // namespace limn::scene
