// Environment maps made of formulas.
#pragma once

#include <functional>

#include "core/scene/scene.h"
#include "glsl/numeric/equirectangular.glsl"

namespace limn::test {

/// Of `width` x `width` / 2 texels, with the radiance of the direction of each texel's centre.
inline scene::Environment environmentOf(int width, const std::function<glm::vec3(glm::vec3)>& radiance) {
  scene::Environment e;
  e.width = width;
  e.height = width / 2;
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < width; ++x)
      e.texels.push_back(radiance(glsl::equirectangular_direction(
          glm::vec2((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                    (static_cast<float>(y) + 0.5f) / static_cast<float>(e.height)))));
  return e;
}

}  // namespace limn::test
