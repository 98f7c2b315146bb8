// Height maps from functions.
#pragma once

#include <functional>
#include <string>

#include "assets/generator/scene.h"

namespace limn::assets {

/// Heights, in sides of the tile, over (u, v) in [0, 1]^2 of a tile that repeats.
using Relief = std::function<double(double u, double v)>;

/// Waves of 1 to 6 periods whose amplitude falls with the square of their frequency; the RMS slope is 0.26.
double noiseRelief(double u, double v);

/// Adds the picture of a relief on a tile of that size.
HeightMap addHeights(Scene& scene, std::string name, glm::ivec2 texels, glm::vec2 tile, const Relief& relief);

}  // namespace limn::assets
