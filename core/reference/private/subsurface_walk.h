// Follows light below a smooth boundary by a random walk: isotropic scattering with reduced coefficients.
#pragma once

#include <cstdint>

#include "core/reference/private/ray_scene.h"
#include "core/reference/private/sampler.h"
#include "core/reference/private/surface.h"

namespace limn::reference {

/// Holds what a body consists of, for one channel.
struct WalkMatter {
  double extinction = 1;  ///< sigma_t', per metre
  double albedo = 0;      ///< a' = sigma_s' / sigma_t'
  double eta = 1;         ///< index of refraction, 1 or more
};

/// Holds the end of a walk.
struct WalkEnd {
  double weight = 0;  ///< share of the walk's light that leaves; 0: it was absorbed
  Hit hit;            ///< where it leaves
};

/// Returns where a walk leaves the body of the surface's draw that starts there along the refracted view. The
/// pairs of its random numbers follow `pair`. Walks that meet a front from within are lost: the mesh is no
/// closed body there. Where nothing lies ahead, matter goes on without end.
WalkEnd walkThroughBody(const RayScene& rays, const Surface& from, const WalkMatter& matter,
                        const Sampler& sampler, uint32_t pair);

/// Returns the weight of a walk in a half space that starts along a refracted view at that cosine.
double walkThroughHalfSpace(double cosine, const WalkMatter& matter, const Sampler& sampler, uint32_t pair);

}  // namespace limn::reference
