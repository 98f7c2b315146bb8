// Internal to the scene loader: the lights that emissive rectangles are.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace limn::scene {

/// The uniform rectangles that together emit what `quad` of `primitive` does: the quad itself where its
/// emission is constant. A texture is decomposed as the thesis does with environments (section 5.3.2): its
/// mean radiances over a grid of texturedLightCells^2 cells are covered greedily by rectangles that sum to
/// the same power. Empty where nothing is emitted, and where the texture's coordinates are not one affine map
/// of the rectangle.
std::vector<EmissivePart> emissiveParts(const Scene& scene, const Primitive& primitive, const Quad& quad);

constexpr int texturedLightCells = 16;
constexpr int mostTexturedLightParts = 64;

}  // namespace limn::scene
