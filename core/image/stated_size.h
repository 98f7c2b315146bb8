// Declares what the header of a picture says of its size, before a decoder sees the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

struct StatedSize {
  std::uint64_t width = 0, height = 0;  ///< pixels
};

/// Returns the size that a PNG, a JPEG or a WebP states, unchecked; 0 x 0 for anything else, and where the
/// header is damaged. Layouts: ISO/IEC 15948, 11.2.2; ITU-T T.81, B.2.2; RFC 9649, 2.5 to 2.7.
StatedSize statedSize(std::span<const std::byte> bytes);

}  // namespace limn
