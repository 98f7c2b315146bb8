// Declares pictures whose pixels are means over their areas: several frames, each with its pixel centres at
// another place within the pixels, averaged in linear light.
#pragma once

#include <functional>
#include <glm/vec2.hpp>

#include "core/base/export.h"
#include "core/image/image.h"
#include "core/render/renderer.h"
#include "core/scene/scene.h"

namespace limn::render {

/// Returns a camera whose pixel centres lie at `offset` from those of `camera`, in pixels to the right and
/// up, in pictures of that size: the view is sheared along its axis, which moves every ray by the same part
/// of a pixel and leaves distances along the axis as they are.
LIMN_API scene::CameraPose shifted(const scene::CameraPose& camera, const glm::dvec2& offset,
                                   glm::ivec2 size);

/// Returns a picture of which each pixel is the mean of aa x aa samples at the centres of the aa x aa parts
/// of its area, as reference::Request::aa has them: the renderer's frames of as many cameras. `renderFrame`
/// renders each of them, with the camera set; at the start of a sequence (Renderer::framesOfPicture()) the
/// first of them several times. R, G, B and A are averaged; the other channels are those of
/// one sample, the reference's. With aa = 1 it is the frame itself. The renderer is left with `camera`.
LIMN_API Image supersample(Renderer& renderer, const scene::CameraPose& camera, glm::ivec2 size, int aa,
                           const std::function<void()>& renderFrame);
/// Does the same with Renderer::render().
LIMN_API Image supersample(Renderer& renderer, const scene::CameraPose& camera, glm::ivec2 size, int aa);

}  // namespace limn::render
