// Declares the slopes of height maps as textures: what normals are made of, level by level.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/relief/height_field.h"

namespace limn::relief {

struct SlopeLevel {
  glm::ivec2 size{0};
  std::vector<glm::vec2> slopes;  ///< at texels, x running fastest: dz over metres along u and along v
};

/// Returns HeightField::slope() of every texel, kept to a steepness whose square is finite, and levels of
/// half the size each down to 1 x 1. Slopes average linearly: each level has the mean of the one before.
LIMN_API std::vector<SlopeLevel> slopeLevels(const HeightField& field);

}  // namespace limn::relief
