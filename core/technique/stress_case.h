// Stability cases: declared beside a technique's parameters, run by `limn stress` and by the tests.
//
//     constexpr limn::StressCase stress[] = {
//         {.name = "foliage", .scene = "plant"},
//         {.name = "smallest map", .settings = "shadow_map_size=16", .factor = 4},
//     };
#pragma once

#include <cstdint>

namespace limn {

/// What is done to a scene before a technique has to cope with it, and what StressCase::amount says of it.
enum class StressChange : uint8_t {
  none,
  sceneScale,    ///< every length times amount
  lightSize,     ///< sides of rectangle lights: amount times the scene's radius
  depthRange,    ///< specks before and behind the scene, as the first light sees it, their distances amount
                 ///< apart
  contact,       ///< a plate over the floor at amount times the scene's radius
  edgeOn,        ///< the first light in the plane of the floor; amount is not looked at
  imageWidth,    ///< a picture of amount pixels in one row
  radiance,      ///< every light times amount
  albedo,        ///< every base colour becomes amount
  noLight,       ///< neither lights nor environment
  cameraInside,  ///< the camera in the middle of the smallest object
  oneTriangle,   ///< all geometry replaced by one triangle
  degenerate,    ///< triangles without area added
  invalidVertices,  ///< a triangle with a NaN vertex added
  cameraNear,       ///< the camera at amount radii (of its box) from the middle of the smallest object
  refraction,       ///< the index of refraction of every material becomes amount
};

struct StressCase {
  const char* name;
  StressChange change = StressChange::none;
  double amount = 0;
  const char* scene = "balls";  ///< asset
  const char* settings = "";    ///< "NAME=VALUE NAME=VALUE" of the technique's parameters
  /// The error may be this many times that of the unchanged scene with default parameters (or of 0.01, if
  /// that is more); beyond it the case counts as degraded. 0: the picture is too unlike
  /// that scene's for its error to say anything; only its values are looked at.
  double factor = 1.5;
};

}  // namespace limn
