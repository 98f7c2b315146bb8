// Materials and their textures.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image.h"
#include "core/image/stated_size.h"
#include "core/scene/mip_chain.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

Wrap wrapMode(int gl) {
  if (gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  return gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

/// The extension's object, or null.
const tinygltf::Value* extension(const tinygltf::ExtensionMap& map, const char* name) {
  const auto found = map.find(name);
  return found != map.end() && found->second.IsObject() ? &found->second : nullptr;
}

double get(const tinygltf::Value& object, const char* key, double absent) {
  const tinygltf::Value& value = object.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : absent;
}

}  // namespace

const Loader::ImageSource& Loader::imageAt(int index, const std::string& what) const {
  if (index < 0 || static_cast<std::size_t>(index) >= imageSources_.size())
    fail(fmt::format("{}: image {} does not exist; there are {}", what, index, imageSources_.size()));
  return imageSources_[static_cast<std::size_t>(index)];
}

std::string Loader::imageLabel(int index) const {
  const ImageSource& source = imageSources_[static_cast<std::size_t>(index)];
  const bool named = source.view < 0 && !isDataUri(source.uri);
  return fmt::format("image {}{}{}", index, source.name.empty() ? "" : " '" + source.name + "'",
                     named ? " (" + oneLine(source.uri, 80) + ")" : "");
}

std::span<const std::byte> Loader::imageBytes(const ImageSource& source, const std::string& label,
                                              std::vector<std::byte>& storage) const {
  if (source.view >= 0) return viewBytes(source.view, label);
  storage = uriBytes(source.uri, label, std::uint64_t{1} << 32);
  return storage;
}

std::optional<Image8> Loader::decodeImage(int index, bool another, const std::string& what) {
  const ImageSource& source = imageAt(index, what);
  const std::string label = imageLabel(index);

  std::vector<std::byte> storage;
  std::span<const std::byte> bytes;
  // One damaged picture is no reason to show nothing: the factors of what it is for stand alone.
  const auto withoutImage = [&](const std::string& problem) {
    warn(fmt::format("{}; {} {}", problem, what, another ? "takes its other image" : "goes without it"));
    return std::nullopt;
  };
  if (const auto known = unreadable_.find(index); known != unreadable_.end())
    return withoutImage(known->second);
  try {
    bytes = imageBytes(source, label, storage);
    if (bytes.empty()) throw Error(label + ": it is empty; PNG, JPEG or WebP is accepted");
  } catch (const Error& error) {
    return withoutImage(unreadable_[index] = error.what());
  }
  // Before it is decoded: a damaged one may take as long as a sound one.
  const std::uint64_t stated = statedTexels(bytes, label);
  texels_ += stated;
  Image8 decoded;
  try {
    decoded = readImage8Memory(bytes, label);
  } catch (const Error& error) {
    return withoutImage(unreadable_[index] = error.what());
  }
  const std::uint64_t texels =
      static_cast<std::uint64_t>(decoded.width) * static_cast<std::uint64_t>(decoded.height);
  texels_ += texels - std::min(texels, stated);
  if (texels_ > limits_.imageTexels)
    fail(fmt::format("image {}: more than {} texels in all images", index, limits_.imageTexels));
  return decoded;
}

int Loader::addImage(int index, bool srgb, Image8 decoded) {
  const std::string& name = imageSources_[static_cast<std::size_t>(index)].name;
  TextureImage image;
  image.name = name.empty() ? fmt::format("#{}", index) : name;
  image.srgb = srgb;
  image.levels.push_back({decoded.width, decoded.height, std::move(decoded.data)});
  buildMipChain(image);
  scene_.images.push_back(std::move(image));
  return static_cast<int>(scene_.images.size()) - 1;
}

int Loader::readImage(int index, bool another, bool srgb, const std::string& what) {
  const int first = imageAt(index, what).first;
  const auto known = imageIndex_.find({first, srgb});
  if (known != imageIndex_.end()) return known->second;
  std::optional<Image8> decoded = decodeImage(first, another, what);
  return imageIndex_[{first, srgb}] = decoded ? addImage(first, srgb, *std::move(decoded)) : kNone;
}

int Loader::firstImage(const tinygltf::Texture& texture, const std::string& what,
                       const std::function<int(int image, bool another)>& read) {
  const tinygltf::Value* webp = extension(texture.extensions, "EXT_texture_webp");
  const int preferred = webp != nullptr && webp->Has("source") ? webp->Get("source").GetNumberAsInt() : kNone;
  const bool another = texture.source != kNone;
  if (preferred == kNone && !another) warn(what + ": its texture has no PNG, JPEG or WebP image");
  int image = kNone;
  if (preferred != kNone) image = read(preferred, another);
  if (image == kNone && another) image = read(texture.source, false);
  return image;
}

int Loader::readTextureImage(const tinygltf::Texture& texture, bool srgb, const std::string& what) {
  return firstImage(texture, what,
                    [&](int index, bool another) { return readImage(index, another, srgb, what); });
}

std::uint64_t Loader::statedTexels(std::span<const std::byte> bytes, const std::string& label) const {
  const auto [width, height] = statedSize(bytes);
  if (width > static_cast<std::uint64_t>(kMaxImageSide) ||
      height > static_cast<std::uint64_t>(kMaxImageSide) ||
      width * height > limits_.imageTexels - std::min(texels_, limits_.imageTexels)) {
    fail(fmt::format("{}: {}x{} texels; at most {} per side and {} in all images are accepted", label, width,
                     height, kMaxImageSide, limits_.imageTexels));
  }
  return width * height;
}

const tinygltf::Texture& Loader::textureAt(int index, const std::string& what) const {
  if (index < 0 || static_cast<std::size_t>(index) >= model_->textures.size())
    fail(fmt::format("{}: texture {} does not exist; there are {}", what, index, model_->textures.size()));
  return model_->textures[static_cast<std::size_t>(index)];
}

std::pair<Wrap, Wrap> Loader::wrapsOf(const tinygltf::Texture& texture, const std::string& what) const {
  if (texture.sampler == -1) return {Wrap::repeat, Wrap::repeat};
  if (texture.sampler < 0 || static_cast<std::size_t>(texture.sampler) >= model_->samplers.size())
    fail(fmt::format("{}: sampler {} does not exist; there are {}", what, texture.sampler,
                     model_->samplers.size()));
  const tinygltf::Sampler& sampler = model_->samplers[static_cast<std::size_t>(texture.sampler)];
  return {wrapMode(sampler.wrapS), wrapMode(sampler.wrapT)};
}

Loader::TextureInfo Loader::textureInfo(const tinygltf::Value& object) {
  const auto whole = [&](const char* key, int absent) {
    const tinygltf::Value& value = object.Get(key);
    return value.IsNumber() ? value.GetNumberAsInt() : absent;
  };
  const tinygltf::Value& extensions = object.Get("extensions");
  const bool moved =
      extensions.Has("KHR_texture_transform") && extensions.Get("KHR_texture_transform").IsObject();
  return {whole("index", -1), whole("texCoord", 0),
          moved ? &extensions.Get("KHR_texture_transform") : nullptr};
}

UvUse Loader::uvsOf(const TextureInfo& info, const std::string& what) const {
  UvUse uvs{true, info.texCoord, glm::vec2(0), glm::vec2(1), 0};
  const tinygltf::Value* transform = info.transform;
  if (transform == nullptr) return uvs;
  if (transform->Has("offset")) {
    const auto v = numbers(transform->Get("offset"), 2, what + " KHR_texture_transform offset");
    uvs.offset = {v[0], v[1]};
  }
  if (transform->Has("scale")) {
    const auto v = numbers(transform->Get("scale"), 2, what + " KHR_texture_transform scale");
    uvs.scale = {v[0], v[1]};
  }
  uvs.rotation = number(get(*transform, "rotation", 0), what + " KHR_texture_transform rotation");
  uvs.set = static_cast<int>(std::clamp(get(*transform, "texCoord", info.texCoord), -1., 1e6));
  return uvs;
}

void Loader::readTexture(const TextureInfo& info, bool srgb, TextureRef& out, std::vector<TextureUse>& uses,
                         const std::string& what) {
  if (info.index == -1) return;
  const tinygltf::Texture& texture = textureAt(info.index, what);
  const auto [wrapS, wrapT] = wrapsOf(texture, what);
  const int image = readTextureImage(texture, srgb, what);
  if (image == kNone) return;
  out = {image, wrapS, wrapT};
  uses.push_back({&out, uvsOf(info, what), what});
}

void Loader::readMaterialExtensions(const tinygltf::Material& source, Material& m, const std::string& what) {
  const auto& map = source.extensions;
  const auto readColour = [&](const tinygltf::Value& from, const char* key, double most, glm::vec3& out) {
    if (!from.Has(key)) return;
    const std::string place = fmt::format("{} {}", what, key);
    const std::vector<float> rgb = numbers(from.Get(key), 3, place);
    for (int c = 0; c < 3; ++c) out[c] = ranged(rgb[static_cast<std::size_t>(c)], 0, most, place);
  };
  if (const auto* e = extension(map, "KHR_materials_emissive_strength")) {
    const float strength = ranged(get(*e, "emissiveStrength", 1), 0, 1e30, what + " emissiveStrength");
    for (int c = 0; c < 3; ++c)
      m.emission[c] =
          number(static_cast<double>(m.emission[c]) * strength, what + " emissiveFactor * emissiveStrength");
  }
  if (const auto* e = extension(map, "KHR_materials_ior")) {
    const double ior = get(*e, "ior", 1.5);
    // 0: "infinite", says the extension
    m.ior = ior == 0 ? kInfiniteIndex : ranged(ior, 1, kInfiniteIndex, what + " ior");
  }
  if (const auto* e = extension(map, "KHR_materials_specular")) {
    m.specularFactor = ranged(get(*e, "specularFactor", 1), 0, 1, what + " specularFactor");
    readColour(*e, "specularColorFactor", 1e30, m.specularColour);
    if (e->Has("specularTexture") || e->Has("specularColorTexture"))
      warn(what + ": textures of KHR_materials_specular are ignored");
  }
  if (const auto* e = extension(map, "KHR_materials_transmission")) {
    m.transmission = ranged(get(*e, "transmissionFactor", 0), 0, 1, what + " transmissionFactor");
    if (e->Has("transmissionTexture")) warn(what + ": the transmission texture is ignored");
  }
  if (const auto* e = extension(map, "KHR_materials_volume")) {
    m.thickness = ranged(get(*e, "thicknessFactor", 0), 0, 1e30, what + " thicknessFactor");
    m.attenuationDistance = ranged(get(*e, "attenuationDistance", 0), 0, 1e30, what + " attenuationDistance");
    readColour(*e, "attenuationColor", 1, m.attenuationColour);
    if (e->Has("thicknessTexture")) warn(what + ": the thickness texture is ignored");
  }
}

void Loader::settleSpecularColour(Material& m, const std::string& what) {
  const float brightest = std::max({m.specularColour.x, m.specularColour.y, m.specularColour.z});
  const bool colourAlone = m.ior >= kInfiniteIndex && brightest < 1;
  if (brightest <= 1 && !colourAlone) return;
  // Reflectance at normal incidence (KHR_materials_specular), without specularFactor.
  const double ratio = (m.ior - 1.0) / (m.ior + 1.0);
  const glm::dvec3 reflected = glm::min(ratio * ratio * glm::dvec3(m.specularColour), 1.0);
  const double most = std::max({reflected.x, reflected.y, reflected.z});
  const bool refracts = m.transmission > 0 || m.subsurface;
  if (refracts && !colourAlone)
    warn(fmt::format("{}: specularColorFactor {} is clamped to 1, since the surface refracts light", what,
                     brightest));
  if (refracts || most == 0) {
    m.specularColour = glm::min(m.specularColour, 1.f);
    return;
  }
  constexpr double mostRatio = (kInfiniteIndex - 1.0) / (kInfiniteIndex + 1.0);
  const double root = std::min(std::sqrt(most), mostRatio);
  m.ior = static_cast<float>((1 + root) / (1 - root));
  m.specularColour = glm::vec3(reflected / most);
}

Material Loader::readMaterial(const tinygltf::Material& source, const std::string& what) {
  Material m;
  std::vector<TextureUse> uses;
  m.name = source.name;
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  if (pbr.baseColorFactor.size() == 4) {
    for (int c = 0; c < 4; ++c)
      m.baseColour[c] =
          ranged(pbr.baseColorFactor[static_cast<std::size_t>(c)], 0, 1, what + " baseColorFactor");
  }
  m.metallic = ranged(pbr.metallicFactor, 0, 1, what + " metallicFactor");
  m.roughness = ranged(pbr.roughnessFactor, 0, 1, what + " roughnessFactor");
  if (source.emissiveFactor.size() == 3) {
    for (int c = 0; c < 3; ++c)
      m.emission[c] =
          ranged(source.emissiveFactor[static_cast<std::size_t>(c)], 0, 1e30, what + " emissiveFactor");
  }
  m.doubleSided = source.doubleSided;
  if (source.alphaMode == "MASK") m.alphaCutoff = ranged(source.alphaCutoff, 0, 1e30, what + " alphaCutoff");
  if (source.alphaMode == "BLEND") {
    m.alphaCutoff = 0.5f;
    warn("alphaMode BLEND counts as MASK with a cutoff of 0.5");
  }
  const auto texture = [&](const auto& info, bool srgb, TextureRef& out, const char* slot) {
    readTexture({info.index, info.texCoord, extension(info.extensions, "KHR_texture_transform")}, srgb, out,
                uses, what + " " + slot);
  };
  const tinygltf::Value* glossy = extension(source.extensions, "KHR_materials_pbrSpecularGlossiness");
  // An unlit material shows its base colour alone, whose coordinates are then those that count.
  const bool unlit = source.extensions.contains("KHR_materials_unlit");
  if (glossy == nullptr) texture(pbr.baseColorTexture, true, m.baseColourTexture, "baseColorTexture");
  if (!unlit) {
    if (glossy == nullptr)
      texture(pbr.metallicRoughnessTexture, false, m.metalRoughTexture, "metallicRoughnessTexture");
    texture(source.normalTexture, false, m.normalTexture, "normalTexture");
    texture(source.emissiveTexture, true, m.emissiveTexture, "emissiveTexture");
  }
  m.normalScale = number(source.normalTexture.scale, what + " normalTexture scale");
  readMaterialExtensions(source, m, what);
  if (glossy != nullptr) applySpecularGlossiness(*glossy, m, uses, what);
  if (source.extras.IsObject() && source.extras.Has("limn_material")) {
    const std::string place = what + " limn_material";
    applyModel(m, readModel(source.extras.Get("limn_material"), place), place);
  }
  applySubsurface(source, m, what);
  settleSpecularColour(m, what);
  if (source.extras.IsObject() && source.extras.Has("limn_height")) {
    const std::string place = what + " limn_height";
    m.height = readHeight(source.extras.Get("limn_height"), uses, place);
    if (m.normalTexture.image != kNone)
      warn(place + ": there is a normalTexture too, from which normals are taken");
  }
  UvUse& uvs = uvUses_.emplace_back(settleUvs(std::move(uses), m));
  uvs.used = uvs.used || m.tangents();  // along rising u, where the file has no tangents
  if (unlit) applyUnlit(m, what);
  return m;
}

void Loader::applyUnlit(Material& m, const std::string& what) {
  if (m.model || m.subsurface || m.transmission > 0)
    warn(what + ": KHR_materials_unlit; what else the material says of light is ignored");
  Material unlit;
  unlit.name = m.name;
  unlit.baseColour = glm::vec4(0, 0, 0, m.baseColour.w);
  unlit.baseColourTexture = m.baseColourTexture;  // for its alpha
  unlit.emission = glm::vec3(m.baseColour);
  unlit.emissiveTexture = m.baseColourTexture;
  unlit.metallic = 0;
  unlit.specularFactor = 0;
  unlit.alphaCutoff = m.alphaCutoff;
  unlit.doubleSided = m.doubleSided;
  unlit.unlit = true;
  m = unlit;
}

void Loader::readMaterials() {
  for (std::size_t i = 0; i < model_->materials.size(); ++i) {
    const std::string& name = model_->materials[i].name;
    const std::string what =
        name.empty() ? fmt::format("material {}", i) : fmt::format("material {} '{}'", i, name);
    scene_.materials.push_back(readMaterial(model_->materials[i], what));
  }
}

}  // namespace limn::scene
