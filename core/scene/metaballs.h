// Balls that melt into each other: triangles that change in count and topology with time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// What extras.limn_metaballs says. The balls live in the cube [-1, 1]^3, which toWorld places.
struct Metaballs {
  static constexpr int maxCount = 64, minResolution = 8, maxResolution = 128;
  static constexpr float minRadius = 0.02f, maxRadius = 0.45f;

  int count = 8;         ///< of balls, 1 .. maxCount
  int resolution = 32;   ///< cells along a side of the cube
  float radius = 0.2f;   ///< of a ball that is alone, minRadius .. maxRadius
  uint32_t seed = 0;     ///< chooses the paths
  glm::mat4 toWorld{1};  ///< invertible
};

/// The surface around all balls (Wyvill, McPheeters and Wyvill 1986: kernel of compact support), by marching
/// tetrahedra: closed, inside the cube, with the field's gradient as normals. Every ball follows a path that
/// closes after 12 s. The same time gives the same triangles. Once it has been asked a few times nothing is
/// allocated, as long as no more than two of its answers are held.
LIMN_API std::shared_ptr<GeometrySource> makeMetaballs(const Metaballs& settings);

}  // namespace limn::scene
