#include "core/shading/environment.h"

#include <tbb/parallel_for.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/base/error.h"
#include "core/base/kept_results.h"
#include "core/scene/bilinear.h"
#include "glsl/light/environment.glsl"
#include "glsl/light/prefiltered.glsl"

namespace limn::shading {
namespace {

using glm::dvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

constexpr int kGlossySamples =
    64;  // at level 1; doubled from level to level, which have a quarter of the texels each
constexpr int kIrradianceSourceWidth = 128;
constexpr float kLargestHalf = 65504;

/// Where the first and last rows of a map lie: half a step inside the poles, as in a file, or on them, as in
/// the result.
enum class Rows { inside, onPoles };

/// Map: a FilteredMap or an EvenPicture, here and below.
template <class Map>
const vec3& texel(const Map& map, int x, int y) {
  return map.texels[static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x)];
}

/// The map's value at (u, v), as limn::shading::bilinear() says.
template <class Map>
vec3 between(const Map& map, vec2 uv) {
  return scene::bilinear({map.width, map.height}, scene::Wrap::repeat, scene::Wrap::clamp, uv,
                         [&](int x, int y) { return texel(map, x, y); });
}

vec2 texelCentre(int x, int y, int width, int height) {
  return {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
          (static_cast<float>(y) + 0.5f) / static_cast<float>(height)};
}

/// A map of width x width / 2, every texel a function of its centre's (u, v); rows in parallel.
template <class Function>
FilteredMap makeMap(int width, Rows rows, const Function& function) {
  FilteredMap map{width, width / 2, {}};
  map.texels.resize(static_cast<size_t>(width) * static_cast<size_t>(map.height));
  tbb::parallel_for(0, map.height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      vec2 uv = texelCentre(x, y, width, map.height);
      if (rows == Rows::onPoles) uv.y = static_cast<float>(y) / static_cast<float>(map.height - 1);
      map.texels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] = function(uv);
    }
  });
  return map;
}

/// Points along a texel: where it holds whole pixels, or a pixel whole texels, one for each pixel, which
/// counts for all that it holds. Elsewhere eight: the tents by which pixels are interpolated sum to that
/// within 0.3 %.
int pointsAlong(int pixels, int texels) {
  const bool whole = pixels % texels == 0 || texels % pixels == 0;
  return ((whole ? 1 : 8) * pixels + texels - 1) / texels;
}

/// Mean radiance over each texel, weighted by solid angle.
template <class Map>
FilteredMap resampled(const Map& source, int width, Rows rows) {
  const int height = std::max(width / 2, 1);
  const int across = pointsAlong(source.width, width), down = pointsAlong(source.height, height);
  const float cell = 1.0f / static_cast<float>(width);
  return makeMap(width, rows, [&](vec2 centre) {
    dvec3 sum(0);
    double weights = 0;
    for (int j = 0; j < down; ++j) {
      for (int i = 0; i < across; ++i) {
        const vec2 offset = texelCentre(i, j, across, down) - vec2(0.5f);
        const vec2 uv = centre + offset * vec2(cell, 2 * cell);
        const double weight =
            std::abs(std::sin(std::numbers::pi * static_cast<double>(uv.y))) + 1e-6;  // on the poles
        sum += weight * dvec3(between(source, uv));
        weights += weight;
      }
    }
    return vec3(sum / weights);
  });
}

/// The sum of light times weight(cosine) over the hemisphere about each direction.
template <class Weight>
FilteredMap convolvedOverHemisphere(const FilteredMap& source, const Weight& weight) {
  struct Patch {
    vec3 direction;
    vec3 flux;  // radiance times solid angle
  };
  std::vector<Patch> patches;
  for (int y = 0; y < source.height; ++y) {
    const float solidAngle = glsl::equirectangular_pixel_solid_angle(y, source.width, source.height);
    for (int x = 0; x < source.width; ++x) {
      patches.push_back({glsl::equirectangular_direction(texelCentre(x, y, source.width, source.height)),
                         solidAngle * texel(source, x, y)});
    }
  }
  return makeMap(glsl::environment_irradiance_width, Rows::onPoles, [&](vec2 uv) {
    const vec3 n = glsl::equirectangular_direction(uv);
    dvec3 sum(0);
    for (const Patch& patch : patches) {
      const float cosine = glm::dot(n, patch.direction);
      if (cosine > 0) sum += dvec3(weight(cosine) * patch.flux);
    }
    return vec3(sum);
  });
}

/// One direction of the lobe at normal incidence, in its own frame.
struct LobeSample {
  vec3 direction;
  float weight;
  float level;  ///< of the source's mip chain
};

std::vector<LobeSample> lobeSamples(float alpha, int count, int sourceWidth) {
  const float texelSolidAngle = 8 * glsl::pi / static_cast<float>(sourceWidth * sourceWidth);
  std::vector<LobeSample> samples;
  float total = 0;
  for (int i = 0; i < count; ++i) {
    const glsl::PrefilterSample sample = glsl::prefilter_sample(alpha, i, count);
    if (sample.weight == 0) continue;
    samples.push_back(
        {sample.direction, sample.weight, glsl::prefilter_source_level(sample.spread, texelSolidAngle)});
    total += sample.weight;
  }
  for (LobeSample& sample : samples) sample.weight /= total;
  return samples;
}

vec3 trilinear(const std::vector<FilteredMap>& chain, vec2 uv, float level) {
  const float last = static_cast<float>(chain.size() - 1);
  const float clamped = std::clamp(level, 0.0f, last);
  const size_t low = static_cast<size_t>(clamped), high = std::min(low + 1, chain.size() - 1);
  const float t = clamped - static_cast<float>(low);
  const vec3 sharp = bilinear(chain[low], uv);
  return t == 0 ? sharp : glm::mix(sharp, bilinear(chain[high], uv), t);
}

FilteredMap convolvedWithLobe(const std::vector<FilteredMap>& chain, int level) {
  const float alpha = glsl::environment_alpha(static_cast<float>(level));
  const int width = glsl::environment_filtered_width >> level;
  const std::vector<LobeSample> samples =
      lobeSamples(alpha, kGlossySamples << (level - 1), chain.front().width);
  return makeMap(width, Rows::onPoles, [&](vec2 uv) {
    const glsl::Frame frame = glsl::frame_around(glsl::equirectangular_direction(uv));
    dvec3 sum(0);
    for (const LobeSample& sample : samples) {
      const vec2 place = glsl::equirectangular_uv(glsl::from_local(frame, sample.direction));
      sum += dvec3(sample.weight * trilinear(chain, place, sample.level));
    }
    return vec3(sum);
  });
}

/// The least power of two, 1 or more, by whose square radiance is divided to fit half floats.
float halfFloatRoot(std::span<const FilteredMap> levels) {
  float greatest = 0;
  for (const FilteredMap& level : levels)
    for (const vec3& t : level.texels) greatest = std::max({greatest, t.x, t.y, t.z});
  float root = 1;
  while (greatest > kLargestHalf * root * root) root *= 2;
  return root;
}

/// Texels are divided by the square of `root`, which alpha keeps.
gpu::Texture upload(gpu::Device& device, std::string_view label, GLenum format, float root,
                    std::span<const FilteredMap> levels) {
  gpu::Texture texture(device, label,
                       {.format = format,
                        .width = levels.front().width,
                        .height = levels.front().height,
                        .levels = static_cast<int>(levels.size())});
  texture.setSampling(levels.size() > 1 ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR, GL_LINEAR, GL_REPEAT,
                      GL_CLAMP_TO_EDGE);
  for (size_t i = 0; i < levels.size(); ++i) {
    std::vector<vec4> texels;
    texels.reserve(levels[i].texels.size());
    for (const vec3& t : levels[i].texels) texels.emplace_back(t / (root * root), root);
    texture.upload(static_cast<int>(i), 0, GL_RGBA, GL_FLOAT, texels.data());
  }
  return texture;
}

void requireMap(const scene::Environment& environment) {
  if (!environment) throw Error("environment: there is no map to filter");
}

/// Tells an environment's map from others.
struct MapKey {
  int width, height;
  uint64_t low, high;  ///< hash of the texels
  bool operator==(const MapKey&) const = default;
};

MapKey keyOf(const scene::Environment& environment) {
  const XXH128_hash_t hash =
      XXH3_128bits(environment.texels.data(), environment.texels.size() * sizeof(vec3));
  return {environment.width, environment.height, hash.low64, hash.high64};
}

/// The most memory of what is kept of either kind beside the last one: three filtered environments.
constexpr size_t kKeptMapBytes = size_t{8} << 20;

size_t bytesOf(const FilteredMap& map) {
  return map.texels.size() * sizeof(vec3);
}
size_t bytesOf(const FilteredEnvironment& environment) {
  size_t sum = bytesOf(environment.irradiance);
  for (const FilteredMap& level : environment.radiance) sum += bytesOf(level);
  return sum;
}

/// One of the texels that a coarser one covers, along one axis.
struct Share {
  int index;
  double weight;
};

/// The part of `count` texels along an axis that texel `i` of `coarse` covers; measure(place) integrates the
/// weight from 0 to a place in texels.
template <class Measure>
std::vector<Share> covered(int i, int coarse, int count, const Measure& measure) {
  const double step = static_cast<double>(count) / coarse, begin = i * step, end = (i + 1) * step;
  std::vector<Share> shares;
  for (int k = static_cast<int>(begin); k < count && k < end; ++k)
    shares.push_back({k, measure(std::min(k + 1.0, end)) - measure(std::max<double>(k, begin))});
  return shares;
}

/// The means over the parts of a picture of `size` texels that the texels of one of `to`, no larger, cover,
/// by exact solid angles: it holds the same light.
FilteredMap reduced(const glm::ivec2& size, std::span<const vec3> texels, const glm::ivec2& to) {
  FilteredMap coarse{to.x, to.y, {}};
  coarse.texels.resize(static_cast<size_t>(to.x) * static_cast<size_t>(to.y));
  std::vector<std::vector<Share>> columns;  // alike in all rows
  columns.reserve(static_cast<size_t>(to.x));
  for (int x = 0; x < to.x; ++x)
    columns.push_back(covered(x, to.x, size.x, [](double place) { return place; }));
  tbb::parallel_for(0, to.y, [&](int y) {
    const auto rows =
        covered(y, to.y, size.y, [&](double place) { return -std::cos(std::numbers::pi * place / size.y); });
    for (int x = 0; x < to.x; ++x) {
      dvec3 sum(0);
      double weights = 0;
      for (const Share& column : columns[static_cast<size_t>(x)]) {
        for (const Share& row : rows) {
          const double weight = row.weight * column.weight;
          sum += weight * dvec3(texels[static_cast<size_t>(row.index) * static_cast<size_t>(size.x) +
                                       static_cast<size_t>(column.index)]);
          weights += weight;
        }
      }
      coarse.texels[static_cast<size_t>(y) * static_cast<size_t>(to.x) + static_cast<size_t>(x)] =
          vec3(sum / weights);
    }
  });
  return coarse;
}

/// The side of a picture that maps of `largest` texels are made of: a larger one whose pixels are no whole
/// part of a texel is brought to `largest` by exact means first, in which no pixel counts for more than it
/// holds.
int evenSide(int pixels, int largest) {
  return pixels > largest && pixels % largest != 0 ? largest : pixels;
}

/// The picture of an environment, with such sides.
class EvenPicture {
 public:
  explicit EvenPicture(const scene::Environment& environment)
      : width(evenSide(environment.width, glsl::environment_filtered_width)),
        height(evenSide(environment.height, glsl::environment_filtered_width / 2)),
        texels(environment.texels) {
    const glm::ivec2 size(environment.width, environment.height), even(width, height);
    if (even == size) return;
    reduced_ = reduced(size, environment.texels, even);
    texels = reduced_.texels;
  }
  EvenPicture(const EvenPicture&) = delete;
  EvenPicture& operator=(const EvenPicture&) = delete;

  int width, height;
  std::span<const vec3> texels;

 private:
  FilteredMap reduced_;
};

}  // namespace

vec3 bilinear(const FilteredMap& map, vec2 uv) {
  return between(map, uv);
}

vec3 FilteredMap::sample(const vec3& direction) const {
  return bilinear(*this, glsl::environment_place(direction, height));
}

vec3 FilteredEnvironment::filtered(const vec3& direction, float alpha) const {
  const float level = glsl::environment_level(alpha);
  const size_t low = std::min(static_cast<size_t>(level), radiance.size() - 2);
  return glm::mix(radiance[low].sample(direction), radiance[low + 1].sample(direction),
                  level - static_cast<float>(low));
}

FilteredEnvironment filterEnvironment(const scene::Environment& environment) {
  requireMap(environment);
  const EvenPicture picture(environment);
  std::vector<FilteredMap> chain{resampled(picture, glsl::environment_filtered_width, Rows::inside)};
  while (chain.back().width > 8) {
    chain.push_back(resampled(chain.back(), chain.back().width / 2, Rows::inside));
  }

  FilteredEnvironment result;
  result.irradiance = convolvedOverHemisphere(resampled(picture, kIrradianceSourceWidth, Rows::inside),
                                              [](float cosine) { return cosine; });
  result.radiance.push_back(resampled(picture, glsl::environment_filtered_width, Rows::onPoles));
  for (int level = 1; level < glsl::environment_levels; ++level) {
    result.radiance.push_back(convolvedWithLobe(chain, level));
  }
  return result;
}

FilteredMap filterGrazing(const scene::Environment& environment) {
  requireMap(environment);
  const EvenPicture picture(environment);
  return convolvedOverHemisphere(resampled(picture, kIrradianceSourceWidth, Rows::inside),
                                 [](float cosine) { return cosine * glsl::schlick_weight(cosine); });
}

std::shared_ptr<const FilteredEnvironment> keptEnvironment(const scene::Environment& environment) {
  static KeptResults<MapKey, FilteredEnvironment> kept(kKeptMapBytes, bytesOf);
  return kept.of(keyOf(environment), [&] { return filterEnvironment(environment); });
}

std::shared_ptr<const FilteredMap> keptGrazing(const scene::Environment& environment) {
  static KeptResults<MapKey, FilteredMap> kept(kKeptMapBytes, bytesOf);
  return kept.of(keyOf(environment), [&] { return filterGrazing(environment); });
}

std::vector<FilteredMap> radianceLevels(const scene::Environment& environment) {
  requireMap(environment);
  std::vector<FilteredMap> levels;
  int width = environment.width, height = environment.height;
  const std::vector<vec3>* texels = &environment.texels;
  while (width > 1 || height > 1) {
    levels.push_back(reduced({width, height}, *texels, {std::max(width / 2, 1), std::max(height / 2, 1)}));
    width = levels.back().width;
    height = levels.back().height;
    texels = &levels.back().texels;
  }
  return levels;
}

gpu::Texture makeIrradianceTexture(gpu::Device& device, const FilteredMap& irradiance) {
  return upload(device, "environment irradiance", GL_RGBA32F, 1, {&irradiance, 1});
}

gpu::Texture makeFilteredTexture(gpu::Device& device, const FilteredEnvironment& environment) {
  return upload(device, "filtered environment", GL_RGBA16F, halfFloatRoot(environment.radiance),
                environment.radiance);
}

gpu::Texture makeRadianceTexture(gpu::Device& device, const scene::Environment& environment) {
  const std::vector<FilteredMap> levels = radianceLevels(environment);
  gpu::Texture texture(
      device, "levels of the environment's map",
      {.format = GL_RGB32F, .width = environment.width, .height = environment.height, .levels = 0});
  texture.setSampling(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE);
  texture.upload(0, 0, GL_RGB, GL_FLOAT, environment.texels.data());
  for (size_t i = 0; i < levels.size(); ++i)
    texture.upload(static_cast<int>(i) + 1, 0, GL_RGB, GL_FLOAT, levels[i].texels.data());
  return texture;
}

}  // namespace limn::shading
