// Internal: a frame's picture on the CPU.
#pragma once

#include "core/frame/frame_graph.h"
#include "core/image/image.h"
#include "core/render/renderer.h"

namespace limn::render {

/// R, G, B of `picture`, top row first; with `gbuffer` also what Renderer::read() promises of it. Blocks.
Image readPicture(const frame::FrameGraph& graph, const Settings& settings, frame::TextureHandle picture,
                  const GBuffer* gbuffer);

}  // namespace limn::render
