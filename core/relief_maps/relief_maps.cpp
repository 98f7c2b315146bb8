#include "core/relief_maps/relief_maps.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/error.h"
#include "core/relief/ellipse.h"
#include "core/relief/horizon.h"
#include "glsl/relief/bounce_paths.glsl"
#include "glsl/relief/horizon_map.glsl"

namespace limn::relief_maps {
namespace {

/// Counts the azimuths of the horizons by which the published fit's directions are lit or not: the share of
/// the disc that linear lookups between them get wrong is below 0.001.
constexpr int kFitAzimuths = 64;
constexpr uint32_t kFitSeed = 1;
constexpr float kLargestHalf = 65504;
constexpr int64_t kMostHorizonBytes = int64_t{4} << 30;

int levelsOf(const glm::ivec2& size) {
  return std::bit_width(static_cast<unsigned>(std::max(size.x, size.y)));
}

/// Returns the texels of a level, on top of one another.
int64_t texelsOf(const glm::ivec2& size) {
  return int64_t{size.x} * size.y;
}

/// Returns the texels of all levels.
int64_t texelsOfLevels(const glm::ivec2& size) {
  int64_t texels = 0;
  for (int level = 0; level < levelsOf(size); ++level)
    texels += texelsOf(glsl::relief_level_size(size, level));
  return texels;
}

int64_t wordsOf(const relief::HeightField& field, const ReliefMapDesc& desc) {
  switch (desc.table) {
    case Table::moments:
    case Table::nearest:
      return texelsOfLevels(field.size()) * glsl::relief_ellipse_words;
    case Table::ambient:
      return texelsOfLevels(field.size());
    case Table::published:
      return texelsOf(field.size()) * glsl::relief_ellipse_words;
    case Table::horizons:
      return texelsOf(field.size()) * glsl::relief_horizon_words(desc.azimuths);
    case Table::bounces:
      return texelsOf(field.size()) * (glsl::bounce_path_plane + desc.paths);
    case Table::heights:
      break;
  }
  return texelsOf(field.size());
}

/// Returns the azimuths of the horizons that a table is made from; 0: it needs none.
int azimuthsOf(const ReliefMapDesc& desc) {
  switch (desc.table) {
    case Table::moments:
    case Table::nearest:
    case Table::ambient:
    case Table::horizons:
      return desc.azimuths;
    case Table::published:
      return kFitAzimuths;
    case Table::heights:
    case Table::bounces:
      break;
  }
  return 0;
}

/// Throws unless the horizons of each field are small enough.
void checkHorizons(std::span<const relief::HeightField> fields, const ReliefMapDesc& desc) {
  for (const relief::HeightField& field : fields)
    if (const int64_t bytes = reliefHorizonBytes(field, desc); bytes > kMostHorizonBytes)
      throw UsageError(fmt::format(
          "the horizons of a height map of {} x {} texels along {} azimuths take {:.1f} GiB, more than "
          "{} GiB; ask for {}a smaller map",
          field.size().x, field.size().y, azimuthsOf(desc), static_cast<double>(bytes) / (1 << 30),
          kMostHorizonBytes >> 30, desc.table == Table::published ? "" : "fewer azimuths or "));
}

void append(std::vector<uint32_t>& words, const glsl::ReliefEllipse& ellipse) {
  const glm::uvec3 packed = glsl::relief_ellipse_pack(ellipse);
  words.insert(words.end(), {packed.x, packed.y, packed.z});
}

void append(std::vector<uint32_t>& words, float share) {
  words.push_back(std::bit_cast<uint32_t>(share));
}

class ShareMean {
 public:
  void add(float share) {
    count_ += 1;
    sum_ += static_cast<double>(share);
  }
  float mean() const { return static_cast<float>(sum_ / count_); }

 private:
  double count_ = 0, sum_ = 0;
};

/// Returns the mean over what a texel of a smaller map covers, in whole texels.
template <class Mean, class Texel>
Texel meanOf(const std::vector<Texel>& texels, const glm::ivec2& size, const glm::ivec2& smaller,
             const glm::ivec2& at) {
  const glm::ivec2 low = at * size / smaller, high = ((at + 1) * size + smaller - 1) / smaller;
  Mean mean;
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x) mean.add(texels[static_cast<size_t>(y * size.x + x)]);
  return mean.mean();
}

/// All levels are means of the texels themselves, so that spreads are those of all that lie below.
template <class Mean, class Texel>
void appendLevels(std::vector<uint32_t>& words, const relief::HeightField& field,
                  const std::vector<Texel>& texels) {
  for (const Texel& texel : texels) append(words, texel);
  for (int level = 1; level < levelsOf(field.size()); ++level) {
    const glm::ivec2 smaller = glsl::relief_level_size(field.size(), level);
    for (int y = 0; y < smaller.y; ++y)
      for (int x = 0; x < smaller.x; ++x) append(words, meanOf<Mean>(texels, field.size(), smaller, {x, y}));
  }
}

void appendEllipses(std::vector<uint32_t>& words, const relief::HeightField& field,
                    const std::vector<glsl::ReliefEllipse>& texels) {
  appendLevels<relief::EllipseMean>(words, field, texels);
}

/// Of the sky, weighted by the cosine, each azimuth's sector shows the square of its lit radius.
void appendAmbient(std::vector<uint32_t>& words, const relief::HeightField& field, int azimuths) {
  const relief::Horizons horizons = relief::sweepHorizons(field, azimuths);
  std::vector<float> shares(field.texels());
  for (size_t texel = 0; texel < shares.size(); ++texel) {
    double sum = 0;
    for (int i = 0; i < azimuths; ++i) {
      const double radius = relief::litRadius(static_cast<double>(horizons.tangent(i, texel)));
      sum += radius * radius;
    }
    shares[texel] = static_cast<float>(sum / azimuths);
  }
  appendLevels<ShareMean>(words, field, shares);
}

/// Returns the uniform ellipse of a fit: its variance along an axis is a quarter of the squared radius.
glsl::ReliefEllipse uniformEllipse(const glsl::FittedEllipse& fit) {
  const glm::vec2 along = 0.5f * fit.radii.x * fit.axis,
                  across = 0.5f * fit.radii.y * glm::vec2(-fit.axis.y, fit.axis.x);
  return {.centre = fit.centre,
          .xx = along.x * along.x + across.x * across.x,
          .xy = along.x * along.y + across.x * across.y,
          .yy = along.y * along.y + across.y * across.y,
          .spread = 0};
}

void appendPublished(std::vector<uint32_t>& words, const relief::HeightField& field, int count) {
  const relief::Horizons horizons = relief::sweepHorizons(field, kFitAzimuths);
  const std::vector<glm::vec2> directions = relief::randomDisc(count, kFitSeed);
  std::vector<glm::vec3> rays;
  std::vector<glsl::HorizonPlace> places;
  for (const glm::vec2& d : directions) {
    rays.emplace_back(d, std::sqrt(std::max(1 - glm::dot(d, d), 0.f)));
    places.push_back(glsl::horizon_place(rays.back(), kFitAzimuths));
  }
  std::vector<glsl::ReliefEllipse> ellipses(field.texels());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, ellipses.size()), [&](const auto& range) {
    std::vector<uint8_t> lit(directions.size());
    for (size_t texel = range.begin(); texel < range.end(); ++texel) {
      for (size_t i = 0; i < rays.size(); ++i) {
        const float first = horizons.tangent(places[i].first, texel),
                    second = horizons.tangent(places[i].second, texel);
        lit[i] = glsl::horizon_lit(rays[i], first + places[i].weight * (second - first)) ? 1 : 0;
      }
      ellipses[texel] = uniformEllipse(relief::fitPublished(directions, lit));
    }
  });
  for (const glsl::ReliefEllipse& ellipse : ellipses) append(words, ellipse);
}

void appendHorizons(std::vector<uint32_t>& words, const relief::HeightField& field, int azimuths) {
  const relief::Horizons horizons = relief::sweepHorizons(field, azimuths);
  const auto tangent = [&](int azimuth, size_t texel) {
    return azimuth < azimuths ? std::min(horizons.tangent(azimuth, texel), kLargestHalf) : 0.f;
  };
  for (size_t texel = 0; texel < field.texels(); ++texel)
    for (int i = 0; i < azimuths; i += 2)
      words.push_back(glm::packHalf2x16({tangent(i, texel), tangent(i + 1, texel)}));
}

void appendHeights(std::vector<uint32_t>& words, const relief::HeightField& field) {
  for (int y = 0; y < field.size().y; ++y)
    for (int x = 0; x < field.size().x; ++x)
      words.push_back(std::bit_cast<uint32_t>(static_cast<float>(field.texel({x, y}))));
}

uint32_t packedSlope(const glm::dvec2& slope) {
  const auto largest = static_cast<double>(kLargestHalf);
  return glm::packHalf2x16(glm::vec2(glm::clamp(slope, -largest, largest)));
}

/// Returns the number of the texel nearest to a place inside of the map.
uint32_t nearestTexel(const relief::HeightField& field, const glm::vec2& place) {
  return static_cast<uint32_t>(field.index(glm::ivec2(glm::floor(place + 0.5f))));
}

void appendBounces(std::vector<uint32_t>& words, const relief::HeightField& field,
                   const ReliefMapDesc& desc) {
  const size_t texels = field.texels(), first = words.size();
  if (texels >= glsl::bounce_sky)
    throw UsageError(
        fmt::format("a height map of {} x {} texels is too large for light from bump to bump: "
                    "less than 2^24 - 1 texels are accepted",
                    field.size().x, field.size().y));
  words.resize(first + static_cast<size_t>(wordsOf(field, desc)));
  const auto word = [&](size_t plane, size_t texel) -> uint32_t& {
    return words[first + plane * texels + texel];
  };
  for (int y = 0; y < field.size().y; ++y)
    for (int x = 0; x < field.size().x; ++x)
      word(glsl::bounce_slope_plane, field.index({x, y})) = packedSlope(field.slope({x, y}));
  // Packed at once: all paths of a map would take three times as much.
  const auto take = [&](size_t texel, std::span<const relief::BouncePath> list) {
    const float largest = std::ranges::max(list, {}, &relief::BouncePath::weight).weight;
    float sum = 0;
    for (size_t i = 0; i < list.size(); ++i) {
      const uint32_t packed = glsl::bounce_path_pack(
          {.texel = list[i].hits() ? nearestTexel(field, list[i].place) : glsl::bounce_sky,
           .weight = largest > 0 ? list[i].weight / largest : 0});
      sum += glsl::bounce_path_unpack(packed).weight;
      word(glsl::bounce_path_plane + i, texel) = packed;
    }
    const float scale = sum > 0 ? static_cast<float>(desc.paths) / sum : 0;
    word(glsl::bounce_scale_plane, texel) = std::bit_cast<uint32_t>(scale);
  };
  relief::traceBounces(field, desc.bounceDirections, desc.paths, take);
}

void appendField(std::vector<uint32_t>& words, const relief::HeightField& field, const ReliefMapDesc& desc) {
  switch (desc.table) {
    case Table::moments:
      return appendEllipses(words, field,
                            relief::momentEllipses(relief::sweepHorizons(field, desc.azimuths)));
    case Table::nearest:
      return appendEllipses(words, field,
                            relief::nearestEllipses(relief::sweepHorizons(field, desc.azimuths)));
    case Table::ambient:
      return appendAmbient(words, field, desc.azimuths);
    case Table::published:
      return appendPublished(words, field, desc.directions);
    case Table::horizons:
      return appendHorizons(words, field, desc.azimuths);
    case Table::heights:
      return appendHeights(words, field);
    case Table::bounces:
      return appendBounces(words, field, desc);
  }
}

/// Returns the description with what its table does not depend on as by default.
ReliefMapDesc plain(const ReliefMapDesc& desc) {
  ReliefMapDesc result;
  result.table = desc.table;
  switch (desc.table) {
    case Table::moments:
    case Table::nearest:
    case Table::ambient:
    case Table::horizons:
      result.azimuths = desc.azimuths;
      break;
    case Table::published:
      result.directions = desc.directions;
      break;
    case Table::bounces:
      result.paths = desc.paths;
      result.bounceDirections = desc.bounceDirections;
      break;
    case Table::heights:
      break;
  }
  return result;
}

}  // namespace

int64_t reliefTableWords(std::span<const relief::HeightField> fields, const ReliefMapDesc& desc) {
  int64_t words = 0;
  for (const relief::HeightField& field : fields) words += wordsOf(field, desc);
  return words;
}

int64_t reliefHorizonBytes(const relief::HeightField& field, const ReliefMapDesc& desc) {
  return texelsOf(field.size()) * azimuthsOf(desc) * int64_t{sizeof(float)};
}

ReliefTable makeReliefTable(std::span<const relief::HeightField> fields, const ReliefMapDesc& desc) {
  checkHorizons(fields, desc);
  ReliefTable table;
  const bool levels =
      desc.table == Table::moments || desc.table == Table::nearest || desc.table == Table::ambient;
  for (const relief::HeightField& field : fields) {
    table.fields.push_back({.first = static_cast<uint32_t>(table.values.size()),
                            .clamped = field.wrap() == relief::Wrap::clamped ? 1u : 0u,
                            .size = field.size(),
                            .spacing = field.spacing(),
                            .highest = static_cast<float>(field.highest()),
                            .levels = levels ? levelsOf(field.size()) : 1});
    appendField(table.values, field, desc);
  }
  return table;
}

ReliefMapService::ReliefMapService(gpu::Device& device, const scene::Scene& scene)
    : device_(device), scene_(scene) {}
ReliefMapService::~ReliefMapService() = default;

void ReliefMapService::begin() {
  std::erase_if(entries_, [](const auto& entry) { return !entry.second.requested; });
  for (auto& [desc, entry] : entries_) entry.requested = false;
}

ReliefMaps ReliefMapService::request(const ReliefMapDesc& asked) {
  const FrameContext& building = context();
  const ReliefMapDesc desc = plain(asked);
  const int64_t bytes = reliefTableWords(scene_.heights, desc) * int64_t{sizeof(uint32_t)};
  if (bytes > device_.limits().maxStorageBlockBytes)
    throw UsageError(
        fmt::format("tables of height maps take {} MiB, more than the {} MiB of a storage buffer; "
                    "ask for fewer azimuths or paths, or smaller maps",
                    bytes >> 20, device_.limits().maxStorageBlockBytes >> 20));
  auto found = entries_.find(desc);
  if (found == entries_.end()) {
    const ReliefTable table = makeReliefTable(scene_.heights, desc);
    Entry made{.fields = gpu::Buffer::of<glsl::ReliefField>(device_, "relief fields", table.fields),
               .values = gpu::Buffer::of<uint32_t>(device_, "relief values", table.values),
               .handles = {},
               .requested = false};
    found = entries_.emplace(desc, std::move(made)).first;
  }
  Entry& entry = found->second;
  if (!entry.requested)
    entry.handles = {building.graph.importBuffer("relief fields", entry.fields),
                     building.graph.importBuffer("relief values", entry.values)};
  entry.requested = true;
  return entry.handles;
}

}  // namespace limn::relief_maps
