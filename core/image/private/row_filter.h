// Declares separable filtering, one row at a time: the inner loops run over whole rows, so that they
// vectorise.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace limn {

/// Holds `count` rows of `width` floats, addressed by row.
class Rows {
 public:
  Rows(std::size_t width, std::size_t count) : width_(width), data_(width * count) {}
  std::span<float> operator[](std::size_t row) { return {data_.data() + row * width_, width_}; }
  std::span<const float> operator[](std::size_t row) const { return {data_.data() + row * width_, width_}; }

 private:
  std::size_t width_;
  std::vector<float> data_;
};

/// Computes out[x] = sum_t taps[t] * padded[x + t]; `padded` has out.size() + taps.size() - 1 values.
inline void filterAlongRow(std::span<const float> padded, std::span<const float> taps, std::span<float> out) {
  std::fill(out.begin(), out.end(), 0.0f);
  for (std::size_t t = 0; t < taps.size(); ++t) {
    const float weight = taps[t];
    const float* in = padded.data() + t;
    for (std::size_t x = 0; x < out.size(); ++x) out[x] += weight * in[x];
  }
}

/// Computes out[x] = sum_t taps[t] * rows[first + t][x].
inline void filterAcrossRows(const Rows& rows, std::size_t first, std::span<const float> taps,
                             std::span<float> out) {
  std::fill(out.begin(), out.end(), 0.0f);
  for (std::size_t t = 0; t < taps.size(); ++t) {
    const float weight = taps[t];
    const std::span<const float> in = rows[first + t];
    for (std::size_t x = 0; x < out.size(); ++x) out[x] += weight * in[x];
  }
}

}  // namespace limn
