// Internal: reads a frame's picture to the CPU.
#pragma once

#include "core/frame/frame_graph.h"
#include "core/image/image.h"
#include "core/render/renderer.h"

namespace limn::render {

/// Returns R, G, B of `picture`, top row first; with `gbuffer` also the channels that Renderer::read()
/// promises, where `background` says whether something shows where no surface is seen. Waits for the GPU.
Image readPicture(const frame::FrameGraph& graph, const Settings& settings, frame::TextureHandle picture,
                  const GBuffer* gbuffer, bool background);

}  // namespace limn::render
