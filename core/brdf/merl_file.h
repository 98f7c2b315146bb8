// Declares decoding and writing of the files of the MERL BRDF database (Matusik et al. 2003, A Data-Driven
// Reflectance Model): three int32 with the nodes in thetaH, thetaD and phiD, then the red, green and blue
// plane as doubles in the order of TabulatedBrdf::values, all little-endian. Red times 1/1500, green
// times 1.15/1500 and blue times 1.66/1500 is f in 1/sr. A negative number says that nothing was measured.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/brdf/tabulated.h"

namespace limn::brdf {

/// The nodes of every file of the database.
inline constexpr glm::ivec3 kMerlSize{90, 90, 180};

/// Returns the table of a file's content, its gaps filled from their neighbours. Throws Error that begins
/// with `name` unless the content has `size` nodes, as many numbers, all of them finite and no f above
/// kLargestValue, and a node that was measured.
LIMN_API TabulatedBrdf decodeMerl(std::span<const std::byte> bytes, std::string_view name,
                                  const glm::ivec3& size = kMerlSize);

/// Returns the content of a file with the table's values, whatever its size.
LIMN_API std::vector<std::byte> encodeMerl(const TabulatedBrdf& table);

/// Writes a file that appears whole. Throws Error where it cannot be written, or where the table has not the
/// size of the database's.
LIMN_API void writeMerl(const std::filesystem::path& path, const TabulatedBrdf& table);

}  // namespace limn::brdf
