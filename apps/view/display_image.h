// Pictures on their way to and from the window.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

#include "core/gpu/objects.h"
#include "core/image/image.h"

namespace limn::app {

/// R, G, B as the window shows them: clamp(2^EV * value), then sRGB, as PNG files are written. Opaque.
Image8 toneMapped(const Image& image, float exposureEv);

/// RGBA8, top row first.
gpu::Texture toTexture(gpu::Device& device, const Image8& image);

/// What glReadPixels gives (RGB, 8 bits, sRGB-encoded, bottom row first), linear.
Image fromBottomFirst(glm::ivec2 size, std::span<const uint8_t> pixels);

}  // namespace limn::app
