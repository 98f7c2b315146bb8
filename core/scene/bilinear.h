// Declares the bilinear filter of OpenGL on the processor: of textures, environment maps and what lights
// shine through.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "core/scene/scene.h"

namespace limn::scene {

/// Returns the texel of a side of `size` texels that a wrapped index names.
inline int wrapIndex(int i, int size, Wrap wrap) {
  if (i >= 0 && i < size) return i;  // most are: a division is what takes the time of a look-up
  if (wrap == Wrap::clamp) return std::clamp(i, 0, size - 1);
  const int period = wrap == Wrap::mirror ? 2 * size : size;
  i %= period;
  if (i < 0) i += period;
  return i < size ? i : 2 * size - 1 - i;
}

/// Returns the filtered value at (u, v), where texel coordinates fit an int, of an image whose texels are
/// `texelAt(x, y)`.
template <class Texel>
auto bilinear(const glm::ivec2& size, Wrap wrapS, Wrap wrapT, const glm::vec2& uv, const Texel& texelAt) {
  const float s = uv.x * static_cast<float>(size.x) - 0.5f;
  const float t = uv.y * static_cast<float>(size.y) - 0.5f;
  const float s0 = std::floor(s), t0 = std::floor(t);
  const int x0 = wrapIndex(static_cast<int>(s0), size.x, wrapS);
  const int x1 = wrapIndex(static_cast<int>(s0) + 1, size.x, wrapS);
  const int y0 = wrapIndex(static_cast<int>(t0), size.y, wrapT);
  const int y1 = wrapIndex(static_cast<int>(t0) + 1, size.y, wrapT);
  const auto top = glm::mix(texelAt(x0, y0), texelAt(x1, y0), s - s0);
  const auto bottom = glm::mix(texelAt(x0, y1), texelAt(x1, y1), s - s0);
  return glm::mix(top, bottom, t - t0);
}

}  // namespace limn::scene
