#include "core/scene/environment_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/bilinear.h"
#include "glsl/numeric/equirectangular.glsl"
#include "glsl/numeric/srgb.glsl"

namespace limn::scene {
namespace {

/// Interval of the cumulative distribution `cdf` (size + 1 values, from 0 to 1) that holds u, and where in it
/// (0 to 1).
int findInterval(const float* cdf, int size, float u, float& inside) {
  const int i = std::clamp(static_cast<int>(std::upper_bound(cdf, cdf + size + 1, u) - cdf) - 1, 0, size - 1);
  const float width = cdf[i + 1] - cdf[i];
  inside = width > 0 ? std::clamp((u - cdf[i]) / width, 0.f, 1.f) : 0.5f;
  return i;
}

/// Running sums of `weight(i)`, scaled to end at 1 (uniform where all are 0); returns the total.
template <class Weight>
double accumulate(float* cdf, int size, Weight weight) {
  double total = 0;
  for (int i = 0; i < size; ++i) total += weight(i);
  double sum = 0;
  cdf[0] = 0;
  for (int i = 0; i < size; ++i) {
    sum += weight(i);
    cdf[i + 1] = static_cast<float>(total > 0 ? sum / total : (i + 1.0) / size);
  }
  cdf[size] = 1;
  return total;
}

/// Offset in [-1, 1] with density 1 - |offset|.
float sampleTent(float u) {
  return u < 0.5f ? std::sqrt(2.f * u) - 1.f : 1.f - std::sqrt(std::max(2.f - 2.f * u, 0.f));
}

/// The mean of the four pixels around a place on the map, whose values are `value(x, y)`: around wraps, the
/// poles repeat the outer rows.
template <class Value>
auto bilinearOf(const Environment& map, const glm::vec2& uv, const Value& value) {
  return bilinear({map.width, map.height}, Wrap::repeat, Wrap::clamp, uv, value);
}

}  // namespace

bool isBlack(const Environment& environment) {
  const auto black = [](const glm::vec3& texel) { return texel == glm::vec3(0); };
  return environment.scale == 0 || std::ranges::all_of(environment.texels, black);
}

EnvironmentLight::EnvironmentLight(const Environment& environment) : environment_(environment) {
  const int width = environment.width, height = environment.height;
  if (width == 0 || height == 0) return;
  sines_.resize(static_cast<size_t>(height));
  for (int y = 0; y < height; ++y)
    sines_[static_cast<size_t>(y)] = static_cast<float>(std::sin(std::numbers::pi * (y + 0.5) / height));
  columns_.resize(static_cast<size_t>(width + 1) * static_cast<size_t>(height));
  rows_.resize(static_cast<size_t>(height) + 1);
  std::vector<double> rowWeight(static_cast<size_t>(height));
  for (int y = 0; y < height; ++y)
    rowWeight[static_cast<size_t>(y)] =
        accumulate(&columns_[static_cast<size_t>(width + 1) * static_cast<size_t>(y)], width,
                   [&](int x) { return weight(x, y); });
  total_ = accumulate(rows_.data(), height, [&](int y) { return rowWeight[static_cast<size_t>(y)]; });
}

double EnvironmentLight::weight(int x, int y) const {
  const size_t at = static_cast<size_t>(y) * static_cast<size_t>(environment_.width) + static_cast<size_t>(x);
  return static_cast<double>(glsl::luminance(environment_.texels[at]) * sines_[static_cast<size_t>(y)]);
}

glm::vec3 EnvironmentLight::radiance(const glm::vec3& direction) const {
  if (environment_.width == 0) return glm::vec3(0);
  return radianceAt(
      glsl::equirectangular_uv(glsl::environment_lookup_direction(direction, environment_.rotation)));
}

glm::vec3 EnvironmentLight::radianceAt(const glm::vec2& uv) const {
  return environment_.scale * bilinearOf(environment_, uv, [&](int x, int y) {
           return environment_.texels[static_cast<size_t>(y) * static_cast<size_t>(environment_.width) +
                                      static_cast<size_t>(x)];
         });
}

glm::vec3 EnvironmentLight::sample(glm::vec2 u) const {
  const int width = environment_.width, height = environment_.height;
  float insideX = 0, insideY = 0;
  const int y = findInterval(rows_.data(), height, u.y, insideY);
  const int x =
      findInterval(&columns_[static_cast<size_t>(width + 1) * static_cast<size_t>(y)], width, u.x, insideX);
  // Beyond a pole the tent is folded back: together with its own other half it is the repeated row.
  float v = std::abs((static_cast<float>(y) + 0.5f + sampleTent(insideY)) / static_cast<float>(height));
  if (v > 1.f) v = 2.f - v;
  const glm::vec2 uv((static_cast<float>(x) + 0.5f + sampleTent(insideX)) / static_cast<float>(width), v);
  return glsl::environment_world_direction(glsl::equirectangular_direction(uv), environment_.rotation);
}

float EnvironmentLight::pdf(const glm::vec3& direction) const {
  const glm::vec3 lookup = glsl::environment_lookup_direction(direction, environment_.rotation);
  return pdfAt(glsl::equirectangular_uv(lookup), lookup);
}

EnvironmentLight::Sight EnvironmentLight::at(const glm::vec3& direction) const {
  const glm::vec3 lookup = glsl::environment_lookup_direction(direction, environment_.rotation);
  const glm::vec2 uv = glsl::equirectangular_uv(lookup);
  return {radianceAt(uv), pdfAt(uv, lookup)};
}

float EnvironmentLight::pdfAt(const glm::vec2& uv, const glm::vec3& lookup) const {
  const double share =
      bilinearOf(environment_, uv, [&](int x, int y) { return static_cast<float>(weight(x, y) / total_); });
  const double pixels = static_cast<double>(environment_.width) * environment_.height;
  const double sine =
      std::max(std::hypot(static_cast<double>(lookup.x), static_cast<double>(lookup.z)), 1e-12);
  return static_cast<float>(share * pixels / (2 * std::numbers::pi * std::numbers::pi * sine));
}

}  // namespace limn::scene
