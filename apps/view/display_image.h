// Converts pictures on their way to and from the window.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>

#include "core/gpu/objects.h"
#include "core/image/image.h"

namespace limn::app {

/// Returns level 0 of an RGBA8 texture as it is stored. Waits for the GPU.
std::shared_ptr<const Image8> readBack(const gpu::Texture& texture);

/// Returns the linear image of what glReadPixels gives (RGB, 8 bits, sRGB-encoded, bottom row first).
Image fromBottomFirst(glm::ivec2 size, std::span<const uint8_t> pixels);

}  // namespace limn::app
