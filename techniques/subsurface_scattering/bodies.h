// Declares what scatters below the surfaces of a scene, and the points that are drawn for it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "techniques/subsurface_scattering/diffusion_body.glsl"

namespace limn::subsurface_scattering {

/// Says how points are drawn.
struct Drawing {
  bool normalised = false;  ///< normalised diffusion in place of the dipole
  int samples = 16;         ///< of each pixel
  int block = 1;            ///< side of the pattern of pixels whose points differ
  float uniformShare = 0;   ///< of the points: drawn from a disc; rounded to whole points
  float uniformRadius = 3;  ///< of that disc, mean distances of the channel that reaches farthest
  float scale = 1;          ///< factor on all mean free paths

  int points() const { return samples * block * block; }  ///< of one body
  int discPoints() const;                                 ///< of a pixel's samples, drawn from the disc
};

struct Bodies {
  std::vector<glsl::DiffusionBody> bodies;  ///< materials that are alike share one
  std::vector<uint32_t> ofInstances;        ///< for each draw instance the index of its body, or no_body
  /// Holds the points of bodies without textures, in the order of DiffusionBody::first_point: for each place
  /// in the pattern its samples.
  std::vector<glsl::DrawnPoint> points;
  std::vector<glsl::PointDraw> draws;  ///< what is random about them, for bodies with textures
};

/// Refuses more points than a storage block of that size holds.
Bodies findBodies(const scene::Scene& scene, const scene::Pose& pose, const Drawing& drawing,
                  int64_t maxStorageBlockBytes);

}  // namespace limn::subsurface_scattering
