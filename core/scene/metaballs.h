// Declares metaballs: blended balls whose triangles change in count and topology with time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Holds the values of extras.limn_metaballs. The balls live in the cube [-1, 1]^3, which toWorld transforms
/// to world space.
struct Metaballs {
  static constexpr int maxCount = 64, minResolution = 8, maxResolution = 128;
  static constexpr float minRadius = 0.02f, maxRadius = 0.45f;

  int count = 8;          ///< number of balls, 1 .. maxCount
  int resolution = 32;    ///< cells along a side of the cube
  float radius = 0.2f;    ///< of a single isolated ball, minRadius .. maxRadius
  uint32_t seed = 0;      ///< chooses the paths
  glm::mat4 toWorld{1};   ///< invertible
  bool tangents = false;  ///< vertices have some, along circles about the cube's Y axis
};

/// Returns a source of the surface around all balls (Wyvill, McPheeters and Wyvill 1986: kernel of compact
/// support), found by marching tetrahedra: closed, inside the cube, with the field's gradient as normals.
/// Every ball follows a closed path with a period of 12 s. Equal times give equal triangles. After the first
/// few calls nothing is allocated, as long as the caller holds at most two results.
LIMN_API std::shared_ptr<GeometrySource> makeMetaballs(const Metaballs& settings);

}  // namespace limn::scene
