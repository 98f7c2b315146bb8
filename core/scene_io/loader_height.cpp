// The height maps of extras.limn_height.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/image/image.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

/// How far texture coordinates may be from a map's size and from right angles.
constexpr double kMostStretch = 0.1;
/// Amplitude, in texels, above which the steps of 8 bits turn normals by more than half a degree.
constexpr double kMostAmplitude8 = 10;

/// What the triangles of a primitive say about its texture coordinates, as means over its area.
struct UvFit {
  double area = 0;
  glm::dvec2 metres{0};  ///< per unit of u and v
  double cosine = 0;     ///< of the angle between rising u and rising v

  void add(const glm::dvec3& along, const glm::dvec3& across, const glm::dvec2& s, const glm::dvec2& r) {
    const double twice = glm::length(glm::cross(along, across)), turn = s.x * r.y - r.x * s.y;
    if (!(twice > 0) || turn == 0) return;
    const glm::dvec3 u = (r.y * along - s.y * across) / turn, v = (s.x * across - r.x * along) / turn;
    const glm::dvec2 length(glm::length(u), glm::length(v));
    area += twice;
    metres += twice * length;
    cosine += twice * glm::dot(u, v) / (length.x * length.y);
  }
};

double real(const tinygltf::Value& extras, const char* key, double absent) {
  return extras.Has(key) ? extras.Get(key).GetNumberAsDouble() : absent;
}

}  // namespace

int Loader::readHeight(const tinygltf::Value& extras, std::vector<TextureUse>& uses,
                       const std::string& what) {
  if (!extras.IsObject()) fail(what + ": an object {texture, scale, offset, tile} is accepted");
  for (const char* key : {"scale", "offset"}) {
    if (!extras.Has(key)) continue;
    const std::string place = fmt::format("{} {}", what, key);
    if (!extras.Get(key).IsNumber()) fail(place + ": one number (metres) is accepted");
    number(extras.Get(key).GetNumberAsDouble(), place);  // checks it
  }
  const double scale = real(extras, "scale", 1), offset = real(extras, "offset", 0);
  glm::dvec2 tile(1);
  if (extras.Has("tile")) {
    const tinygltf::Value& metres = extras.Get("tile");
    numbers(metres, 2, what + " tile (metres per unit of u and v)");  // checks them
    for (int c = 0; c < 2; ++c) tile[c] = metres.Get(c).GetNumberAsDouble();
  }

  const std::string place = what + " texture";
  const tinygltf::Value none;
  const tinygltf::Value& given = extras.Has("texture") ? extras.Get("texture") : none;
  if (!given.IsObject() || !given.Has("index") || !given.Get("index").IsInt() ||
      (given.Has("texCoord") &&
       !(given.Get("texCoord").IsInt() && given.Get("texCoord").GetNumberAsInt() >= 0)))
    fail(place + ": glTF's object {index, texCoord} is accepted, of whole numbers");
  const TextureInfo info = textureInfo(given);
  const tinygltf::Texture& texture = textureAt(info.index, place);
  if (texture.source == -1)
    fail(fmt::format("{}: texture {} has no image; PNG or EXR is accepted", place, info.index));
  const auto [wrapS, wrapT] = wrapsOf(texture, place);
  if (wrapS != wrapT || wrapS == Wrap::mirror)
    fail(place +
         ": a sampler that repeats (10497) along both u and v, or clamps (33071) along both, is accepted");
  const relief::Wrap wrap = wrapS == Wrap::clamp ? relief::Wrap::clamped : relief::Wrap::periodic;
  uses.push_back({nullptr, uvsOf(info, place), place});

  const ImageSource& source = imageAt(texture.source, place);
  const HeightKey key{source.first, wrap, scale, offset, tile.x, tile.y};
  const auto known = heightIndex_.find(key);
  if (known != heightIndex_.end()) return known->second;
  try {
    const std::string label = imageLabel(texture.source);
    std::vector<std::byte> storage;
    const ImageChannel channel =
        readFirstChannelMemory(imageBytes(source, label, storage), label, limits_.imageTexels - texels_);
    texels_ += channel.values.size();
    const relief::HeightField& field = scene_.heights.emplace_back(glm::ivec2(channel.width, channel.height),
                                                                   channel.values, tile, scale, offset, wrap);
    const double amplitude =
        (field.highest() - field.lowest()) / std::min(field.spacing().x, field.spacing().y);
    if (channel.bits == 8 && amplitude > kMostAmplitude8)
      warn(
          fmt::format("{}: {} has 8 bits for heights over {:.3g} texels, whose steps turn normals; a PNG of "
                      "16 bits or an EXR does not",
                      what, label, amplitude));
  } catch (const Error& error) {
    fail(fmt::format("{}: {}", what, error.what()));
  }
  heightTiles_.push_back(tile);
  return heightIndex_[key] = static_cast<int>(scene_.heights.size()) - 1;
}

void Loader::checkHeightUvs(const Primitive& primitive) {
  const Material& material = scene_.materials[static_cast<std::size_t>(primitive.material)];
  if (material.height == kNone || primitive.uvs.empty()) return;
  UvFit fit;
  for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    const uint32_t a = primitive.indices[i], b = primitive.indices[i + 1], c = primitive.indices[i + 2];
    fit.add(glm::dvec3(primitive.positions[b]) - glm::dvec3(primitive.positions[a]),
            glm::dvec3(primitive.positions[c]) - glm::dvec3(primitive.positions[a]),
            glm::dvec2(primitive.uvs[b]) - glm::dvec2(primitive.uvs[a]),
            glm::dvec2(primitive.uvs[c]) - glm::dvec2(primitive.uvs[a]));
  }
  if (!(fit.area > 0)) return;
  const glm::dvec2 metres = fit.metres / fit.area;
  const glm::dvec2 tile = heightTiles_[static_cast<std::size_t>(material.height)];
  const glm::dvec2 stretch = metres / tile;
  const double shear = std::abs(fit.cosine / fit.area);
  const auto fits = [](double x) { return std::abs(x - 1) <= kMostStretch; };
  if (fits(stretch.x) && fits(stretch.y) && shear <= kMostStretch) return;
  if (!badUvs_.insert(primitive.material).second) return;
  warn(
      fmt::format("material {}{} limn_height: a primitive has {:.3g} x {:.3g} m per unit of u and v, which "
                  "are {:.3g} degrees off a right angle; the map's tile is {:.3g} x {:.3g} m, and its bumps "
                  "are lit as if they had that size",
                  primitive.material, material.name.empty() ? "" : " '" + material.name + "'", metres.x,
                  metres.y, glm::degrees(std::asin(std::min(shear, 1.0))), tile.x, tile.y));
}

}  // namespace limn::scene
