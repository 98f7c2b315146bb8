// One set of texture coordinates for all textures of a material, as both renderers know it. A texture that
// wants others (KHR_texture_transform) is resampled at load, where an image that repeats can show the same.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/image/byte_values.h"
#include "core/scene/mip_chain.h"
#include "core/scene_io/private/loader.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::scene {
namespace {

/// A side that every OpenGL 4.5 accepts.
constexpr int kMostResampledSide = 16384;
/// All resampled images together may have LoadLimits::imageTexels over this, beside the file's own images.
constexpr std::uint64_t kResampledShare = 4;
/// A side up to which images between whose texels others come to lie are made finer, so that they blur less.
constexpr int kFineSide = 1024;
/// Distance in texels below which a place counts as a texel's centre.
constexpr double kOnTexel = 1.0 / 256;
/// Relative error of what counts as a whole number of repeats and a quarter turn: files round pi / 2.
constexpr double kMapError = 1e-5;

/// KHR_texture_transform without its offset: rotation * scale.
glm::dmat2 rotationAndScale(const UvUse& uvs) {
  const double c = std::cos(double{uvs.rotation}), s = std::sin(double{uvs.rotation});
  const glm::dvec2 scale(uvs.scale);
  return {scale.x * glm::dvec2(c, -s), scale.y * glm::dvec2(s, c)};
}

/// The map from the coordinates `in` to the coordinates `of`.
std::optional<UvMap> mapBetween(const UvUse& in, const UvUse& of) {
  const glm::dmat2 from = rotationAndScale(in);
  if (in.set != of.set || glm::determinant(from) == 0) return std::nullopt;
  const glm::dmat2 m = rotationAndScale(of) * glm::inverse(from);
  UvMap map;
  map.turned = std::abs(m[0][0]) < std::abs(m[1][0]);
  const glm::dvec2 along = map.turned ? glm::dvec2(m[1][0], m[0][1]) : glm::dvec2(m[0][0], m[1][1]);
  const glm::dvec2 across = map.turned ? glm::dvec2(m[0][0], m[1][1]) : glm::dvec2(m[1][0], m[0][1]);
  const glm::dvec2 shift = glm::dvec2(of.offset) - m * glm::dvec2(in.offset);
  const glm::dvec2 whole = glm::round(along), size = glm::abs(whole);
  const double most = kMapError * std::max(size.x, size.y);
  for (int c = 0; c < 2; ++c) {
    if (!(size[c] >= 1 && size[c] <= kMostResampledSide) ||
        !(std::abs(along[c] - whole[c]) <= most && std::abs(across[c]) <= most))
      return std::nullopt;
    map.repeats[c] = static_cast<int>(whole[c]);
    map.shift[c] = shift[c] - std::floor(shift[c]);
  }
  return map;
}

/// Two texels along one side of an image, and the second one's share.
struct Tap {
  std::size_t first = 0, second = 0;
  float share = 0;
};

/// The texels of a side of `size` texels that the `count` texels of a resampled one show.
std::vector<Tap> tapsOf(int size, int count, int repeats, double shift) {
  std::vector<Tap> taps(static_cast<std::size_t>(count));
  const auto wrapped = [&](double texel) {
    return static_cast<std::size_t>(texel - size * std::floor(texel / size));
  };
  for (int i = 0; i < count; ++i) {
    const double at = ((i + 0.5) / count * repeats + shift) * size - 0.5;
    const double nearest = std::round(at);
    const bool whole = std::abs(at - nearest) <= kOnTexel;
    const double first = whole ? nearest : std::floor(at);
    taps[static_cast<std::size_t>(i)] = {wrapped(first), wrapped(first + 1),
                                         whole ? 0.f : static_cast<float>(at - first)};
  }
  return taps;
}

/// The image that at u shows what `from` shows at map(u), without its smaller levels.
TextureImage resampled(const TextureImage& from, const UvMap& map, const glm::ivec2& size) {
  const TextureImage::Level& level = from.levels.front();
  const std::vector<Tap> columns =
      tapsOf(level.width, map.turned ? size.y : size.x, map.repeats.x, map.shift.x);
  const std::vector<Tap> rows =
      tapsOf(level.height, map.turned ? size.x : size.y, map.repeats.y, map.shift.y);
  const auto &colour = byteValues(from.srgb), &alpha = byteValues(false);
  TextureImage image;
  image.name = from.name;
  image.srgb = from.srgb;
  TextureImage::Level& to = image.levels.emplace_back();
  to.width = size.x;
  to.height = size.y;
  to.rgba.resize(4 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  std::uint8_t* out = to.rgba.data();
  for (std::size_t y = 0; y < static_cast<std::size_t>(size.y); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(size.x); ++x, out += 4) {
      const Tap &s = columns[map.turned ? y : x], &t = rows[map.turned ? x : y];
      const auto texel = [&](std::size_t column, std::size_t row) {
        return &level.rgba[4 * (row * static_cast<std::size_t>(level.width) + column)];
      };
      const std::array corners{texel(s.first, t.first), texel(s.second, t.first), texel(s.first, t.second),
                               texel(s.second, t.second)};
      if (s.share == 0 && t.share == 0) {
        std::copy_n(corners[0], 4, out);
        continue;
      }
      for (std::size_t c = 0; c < 4; ++c) {
        const auto& values = c < 3 ? colour : alpha;
        const auto value = [&](std::size_t k) { return values[corners[k][c]]; };
        const float mixed =
            glm::mix(glm::mix(value(0), value(1), s.share), glm::mix(value(2), value(3), s.share), t.share);
        const bool encoded = c < 3 && from.srgb;
        out[c] = static_cast<std::uint8_t>(std::lround(255.f * (encoded ? glsl::srgb_encode(mixed) : mixed)));
      }
    }
  }
  return image;
}

}  // namespace

bool Loader::resample(TextureRef& texture, const UvMap& map) {
  const ResampledKey key{texture.image, map.turned, map.repeats.x, map.repeats.y, map.shift.x, map.shift.y};
  if (const auto known = resampledIndex_.find(key); known != resampledIndex_.end()) {
    texture.image = known->second;
    return true;
  }
  const TextureImage& from = scene_.images[static_cast<std::size_t>(texture.image)];
  const glm::dvec2 own(from.levels.front().width, from.levels.front().height);
  glm::dvec2 size = glm::abs(glm::dvec2(map.repeats)) * own;
  if (map.turned) size = {size.y, size.x};
  const glm::dvec2 moved = map.shift * own;
  const bool onTexels =
      glm::all(glm::lessThanEqual(glm::abs(moved - glm::round(moved)), glm::dvec2(kOnTexel)));
  while (!onTexels && 2 * std::max(size.x, size.y) <= kFineSide) size *= 2;
  if (std::max(size.x, size.y) > kMostResampledSide) return false;
  const auto texels = static_cast<std::uint64_t>(size.x * size.y);
  if (texels > limits_.imageTexels / kResampledShare - resampledTexels_) return false;
  resampledTexels_ += texels;
  TextureImage image = resampled(from, map, glm::ivec2(size));
  buildMipChain(image);
  scene_.images.push_back(std::move(image));
  texture.image = resampledIndex_[key] = static_cast<int>(scene_.images.size()) - 1;
  return true;
}

UvUse Loader::settleUvs(std::vector<TextureUse> uses, const Material& material) {
  // A model or subsurface scattering may have taken textures away.
  std::erase_if(uses, [](const TextureUse& use) { return use.texture && use.texture->image == kNone; });
  if (uses.empty()) return {};
  const auto mapFrom = [&](const UvUse& uvs, const TextureUse& use) -> std::optional<UvMap> {
    if (use.texture == nullptr || use.texture->wrapS != Wrap::repeat || use.texture->wrapT != Wrap::repeat)
      return std::nullopt;
    const std::optional<UvMap> map = mapBetween(uvs, use.uvs);
    // Tangents are along the material's own u and v.
    const bool directed = use.texture == &material.normalTexture || material.model;
    if (map && directed && (map->turned || map->repeats.x < 0 || map->repeats.y < 0)) return std::nullopt;
    return map;
  };
  const auto leads = [&](const TextureUse& first) {
    return std::ranges::all_of(uses, [&](const TextureUse& use) {
      return use.uvs == first.uvs || mapFrom(first.uvs, use).has_value();
    });
  };
  const auto leader = std::ranges::find_if(uses, leads);
  const UvUse uvs = (leader == uses.end() ? uses.front() : *leader).uvs;
  for (const TextureUse& use : uses) {
    if (use.uvs == uvs) continue;
    const std::optional<UvMap> map = mapFrom(uvs, use);
    if (!map || !resample(*use.texture, *map)) {
      warn(fmt::format(
          "{}: its texture coordinates differ from those of the material's other textures, whose are used",
          use.what));
    }
  }
  return uvs;
}

}  // namespace limn::scene
