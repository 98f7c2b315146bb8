// Declares how the scene loader turns emissive rectangles into lights. Internal to the loader.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace limn::scene {

/// Returns the uniform rectangles that together emit what `quad` of `primitive` emits: the quad itself when
/// its emission is constant. A texture is decomposed as the thesis does with environments (section 5.3.2):
/// its mean radiances over a grid of kTexturedLightCells^2 cells are covered greedily by rectangles whose
/// power has the same sum. Returns nothing when nothing is emitted, and when the texture's coordinates are
/// not one affine map of the rectangle.
std::vector<EmissivePart> emissiveParts(const Scene& scene, const Primitive& primitive, const Quad& quad);

constexpr int kTexturedLightCells = 16;
constexpr int kMostTexturedLightParts = 64;

}  // namespace limn::scene
