// Declares stability cases: they stand beside a technique's parameters; `limn stress` and the tests run them.
//
//     constexpr limn::StressCase kStress[] = {
//         {.name = "foliage", .scene = "plant"},
//         {.name = "smallest map", .settings = "shadow_map_size=16", .factor = 4},
//     };
#pragma once

#include <cstdint>

namespace limn {

/// Says how a scene is changed before a technique renders it, and what StressCase::amount means for it.
enum class StressChange : uint8_t {
  none,
  sceneScale,       ///< every length times amount
  lightSize,        ///< sides of rectangle lights: amount times the scene's radius
  depthRange,       ///< specks before and behind the scene for the first light; amount: ratio of distances
  contact,          ///< a plate over the floor at amount times the scene's radius
  edgeOn,           ///< the first light in the plane of the floor; amount is ignored
  imageWidth,       ///< a picture of amount pixels in one row
  radiance,         ///< every light times amount
  albedo,           ///< every base colour becomes amount
  noLight,          ///< neither lights nor environment
  cameraInside,     ///< the camera in the middle of the smallest object
  oneTriangle,      ///< all geometry replaced by one triangle
  degenerate,       ///< triangles without area added
  invalidVertices,  ///< a triangle with a NaN vertex added
  cameraNear,       ///< the camera at amount radii (of its box) from the middle of the smallest object
  refraction,       ///< the index of refraction of every material becomes amount
};

/// Holds one stability case: a change of a scene, and how much the error may grow by it.
struct StressCase {
  const char* name;
  StressChange change = StressChange::none;
  double amount = 0;
  const char* scene = "balls";  ///< asset
  const char* settings = "";    ///< "NAME=VALUE NAME=VALUE" of the technique's parameters
  /// Names a technique that runs along with its default parameters, for the light that the reference holds
  /// besides: airlight, where caustic lines are a part of what a medium scatters. Empty: none.
  const char* beside = "";
  /// Limits the error in each term that the technique answers, as a multiple of that of the unchanged scene
  /// with default parameters, or with `settings` where the case has the name of one that all techniques meet
  /// and stands in its place (or of 0.01, if that is more); beyond it the case counts as degraded. 0: the
  /// picture differs too much from that scene's for the error to be meaningful; only its values are checked.
  double factor = 1.5;
};

}  // namespace limn
