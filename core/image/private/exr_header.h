// Declares a check of an OpenEXR file's header that runs before the library reads it, since the library
// allocates whatever memory the header claims.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

/// Limit on the values (pixels times channels) of a tile: the library holds several tiles at once, however
/// small the picture is.
inline constexpr std::uint64_t kMaxTileValues = std::uint64_t{1} << 24;

/// Returns an empty string, or what is wrong with the header of a file that starts with OpenEXR's magic
/// number: an attribute that is longer than the file or not as long as a value of its type, or sides or tiles
/// larger than their limits. Everything else is left to the library. Layout: "OpenEXR File Layout", sections
/// "Header" and "Predefined attribute types".
std::string exrHeaderProblem(std::span<const std::byte> bytes);

}  // namespace limn
