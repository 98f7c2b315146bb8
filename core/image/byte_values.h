// Declares what the bytes of pictures stand for.
#pragma once

#include <array>

#include "core/base/export.h"

namespace limn {

/// Returns the linear value from 0 to 1 of each byte: decoded from sRGB, as colours are stored, or as a share
/// of 255, as alpha and data are.
LIMN_API const std::array<float, 256>& byteValues(bool srgb);

}  // namespace limn
