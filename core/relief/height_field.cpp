#include "core/relief/height_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace limn::relief {
namespace {

/// Returns the texel of an axis that stands for texel `i`, which most often is one itself: a division takes
/// longer than all else that a height is made of.
int wrapped(int i, int size, Wrap wrap) {
  if (i >= 0 && i < size) return i;
  if (wrap == Wrap::clamped) return std::clamp(i, 0, size - 1);
  const int rest = i % size;
  return rest < 0 ? rest + size : rest;
}

}  // namespace

HeightField::HeightField(const glm::ivec2& size, const std::vector<float>& values, const glm::dvec2& tile,
                         double scale, double offset, Wrap wrap)
    : size_(size), wrap_(wrap), spacing_(tile / glm::dvec2(size)) {
  if (size.x < 1 || size.y < 1)
    throw Error(fmt::format("height map of {} x {} texels: at least 1 x 1 is needed", size.x, size.y));
  if (values.size() != static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y))
    throw Error(fmt::format("height map of {} x {} texels has {} values: one for each texel is needed",
                            size.x, size.y, values.size()));
  if (!std::isfinite(scale) || !std::isfinite(offset))
    throw Error(fmt::format("height map with scale {} and offset {}: both must be finite", scale, offset));
  if (!(tile.x > 0) || !(tile.y > 0) || !std::isfinite(tile.x) || !std::isfinite(tile.y))
    throw Error(
        fmt::format("height map with a tile of {} x {} m: both must be above 0 and finite", tile.x, tile.y));
  heights_.reserve(values.size());
  for (const float value : values) {
    const double height = scale * static_cast<double>(value) + offset;
    if (!(std::abs(height) <= static_cast<double>(std::numeric_limits<float>::max())))
      throw Error(fmt::format("height map with a height of {} m: finite 32-bit heights are needed", height));
    heights_.push_back(height);
  }
  const auto [lowest, highest] = std::minmax_element(heights_.begin(), heights_.end());
  lowest_ = *lowest;
  highest_ = *highest;
}

std::size_t HeightField::index(const glm::ivec2& at) const {
  return static_cast<std::size_t>(wrapped(at.y, size_.y, wrap_)) * static_cast<std::size_t>(size_.x) +
         static_cast<std::size_t>(wrapped(at.x, size_.x, wrap_));
}

Patch HeightField::patch(const glm::ivec2& cell) const {
  const auto row = [this](int y) {
    return heights_.begin() + static_cast<std::ptrdiff_t>(wrapped(y, size_.y, wrap_)) * size_.x;
  };
  const auto low = row(cell.y), high = row(cell.y + 1);
  const int left = wrapped(cell.x, size_.x, wrap_), right = wrapped(cell.x + 1, size_.x, wrap_);
  const double z00 = low[left], z10 = low[right], z01 = high[left], z11 = high[right];
  return {.corner = z00, .slope = {z10 - z00, z01 - z00}, .twist = z11 - z10 - (z01 - z00)};
}

double HeightField::height(const glm::dvec2& place) const {
  const glm::dvec2 corner = glm::floor(place);
  return patch(glm::ivec2(corner)).at(place - corner);
}

glm::dvec2 HeightField::slope(const glm::ivec2& at) const {
  const glm::ivec2 x(1, 0), y(0, 1);
  const glm::dvec2 rise(texel(at + x) - texel(at - x), texel(at + y) - texel(at - y));
  return rise / (2.0 * spacing_);
}

glm::dvec3 HeightField::normal(const glm::ivec2& at) const {
  return glm::normalize(glm::dvec3(-slope(at), 1));
}

double HeightField::steepest() const {
  // Slopes are linear over a cell along each axis, so that the steepest place is a corner.
  double most = 0;
  for (int y = 0; y < size_.y; ++y)
    for (int x = 0; x < size_.x; ++x) {
      const Patch cell = patch({x, y});
      for (const glm::dvec2& corner :
           {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
        const glm::dvec2 slope = (cell.slope + cell.twist * glm::dvec2(corner.y, corner.x)) / spacing_;
        most = std::max(most, glm::length(slope));
      }
    }
  return most;
}

}  // namespace limn::relief
