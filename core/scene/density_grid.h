// Declares densities of inhomogeneous media on the CPU: smoke at a time, lookups, and integrals along rays.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "glsl/media/smoke.glsl"

namespace limn::scene {

/// Gives a medium a grid. A grid that is 0 everywhere is no medium: the coefficients are removed.
LIMN_API void setGrid(Medium& medium, DensityGrid grid);

/// Returns the density at a place, interpolated as OpenGL interpolates a volume; 0 outside the box.
LIMN_API float densityAt(const DensityGrid& grid, const glm::vec3& place);

/// Returns the integral of the density over from < t < to along origin + t direction, in lengths of
/// `direction`. The result is exact: between the planes through voxel centres the density along a line is a
/// cubic polynomial, which Gaussian quadrature with two nodes integrates without error.
LIMN_API double densityLength(const DensityGrid& grid, const glm::vec3& origin, const glm::vec3& direction,
                              float from, float to);

/// Returns the size, in voxels, of the grid in which smoke is looked up.
LIMN_API glm::ivec3 smokeVoxels(const Smoke& smoke);
/// Returns the parameters of glsl/media/smoke.glsl at `time` seconds.
LIMN_API glsl::SmokeBlock smokeBlock(const Smoke& smoke, double time);
/// Returns the density grid of the smoke at `time` seconds.
LIMN_API DensityGrid smokeAt(const Smoke& smoke, double time);
/// Returns smoke that fills the lower part of a scene with these bounds, 1 m where they have no size, with
/// whirls of a quarter of the scene's size.
LIMN_API Smoke smokeIn(const Bounds& bounds);

/// Returns the transform from world space to the unit cube of the medium's grid or smoke; the identity when
/// there is neither.
LIMN_API glm::mat4 mediumToBox(const Medium& medium);

}  // namespace limn::scene
