// Declares the decomposition of an environment into few area lights at infinity, so that every shadow
// technique can shadow it (the thesis's section 5.3.2).
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"
#include "core/image/greedy_regions.h"
#include "core/image/image.h"
#include "core/scene/scene.h"

namespace limn::shading {

/// Describes one face of a cube around the viewer: points n + a u + b v with a, b in [-1, 1], cross(u, v) =
/// n. Texel (x, y) of F x F covers a in -1 + 2/F [x, x + 1], b in 1 - 2/F [y, y + 1].
struct CubeFace {
  glm::vec3 n, u, v;
};
/// Lists the faces in the order +x, -x, +y, -y, +z, -z.
LIMN_API extern const std::array<CubeFace, 6> kCubeFaces;

/// Returns the solid angle (sr) of the part [a0, a1] x [b0, b1] of a cube's face: exact, in double precision.
LIMN_API double faceSolidAngle(double a0, double b0, double a1, double b1);

/// Returns the faces of an environment's cube map in its own frame (rotation and scale not applied); energy
/// is radiance times solid angle. The sum over the faces equals that over the map's pixels of radiance times
/// exact solid angle; negative pixels and those that are not finite count as 0. Throws Error without a map.
LIMN_API std::array<TexelGrid, 6> cubeMap(const scene::Environment& environment, int resolution);

struct DecompositionSettings {
  double threshold = 0.015;  ///< in (0, 1): a smaller one gives fewer lights
  /// Texels along a face's side; the number of lights depends on it. With 48, thresholds of 0.015, 0.025 and
  /// 0.035 give 29, 38 and 56 lights for limn's sky; the thesis reports about 30, 45 and 60 for its maps.
  int resolution = 48;
  RegionShape shape = RegionShape::squares;
};
constexpr int kLargestFaceResolution = 512;
constexpr int kMostEnvironmentLights = 1024;

struct EnvironmentDecomposition {
  int resolution = 0;
  std::vector<int> faces;  ///< of each light
  std::vector<Region>
      regions;  ///< of each light, in texels of its face; energy in W/m^2 on a perpendicular surface
  std::vector<scene::DistantRectangle> lights;  ///< brightest first, in the environment's own frame
};

/// Returns the decomposition. Throws UsageError for settings that are out of range or would give more than
/// kMostEnvironmentLights.
LIMN_API EnvironmentDecomposition decomposeEnvironment(const scene::Environment& environment,
                                                       const DecompositionSettings& settings);

/// Returns the map times 2^exposureEv, `width` pixels wide, with the outlines of the lights in green (0, 1,
/// 0).
LIMN_API Image decompositionOverlay(const scene::Environment& environment,
                                    const EnvironmentDecomposition& decomposition, int width,
                                    float exposureEv = 0);

}  // namespace limn::shading
