// Declares files of measured BRDFs of any kind: MERL's .binary, the RGL's .bsdf, and .bsdf files of BRDFs
// over two whole directions, which are limn's own. These use the RGL's container for one array, "disc_pairs",
// of half or float type and shape (N, N, N, N, 3): f in 1/sr at v.y, v.x, l.y, l.x and channel, the order of
// AnisotropicTable::values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/export.h"
#include "core/brdf/tabulated.h"

namespace limn::brdf {

/// Isotropic, or over two directions.
using MeasuredBrdf = std::variant<TabulatedBrdf, AnisotropicTable>;

/// Bytes that a file of any kind may have, alone or of a scene. One of MERL's has 35 MB.
inline constexpr std::uint64_t kLargestMeasuredFile = std::uint64_t{64} << 20;

/// The texels a side that tables over two directions may have in files: 64 MB of float numbers.
inline constexpr int kMostDiscTexels = 48;

/// How the numbers of a table over two directions are kept in a file.
enum class MeasuredFormat { half, float32 };

/// Returns the table of a file's content. What begins as the RGL's container, or whose name ends in .bsdf, in
/// quotes or not, is limn's own where it has the array "disc_pairs" and the RGL's otherwise; all else is
/// MERL's. Throws Error that begins with `name` where the content is no such file.
LIMN_API MeasuredBrdf decodeMeasured(std::span<const std::byte> bytes, std::string_view name);
LIMN_API MeasuredBrdf readMeasured(const std::filesystem::path& path);

/// Returns the table of the content of a file of limn's own. Throws Error that begins with `name` unless its
/// array has 1 to kMostDiscTexels texels a side and numbers from 0 to kLargestValue.
LIMN_API AnisotropicTable decodeDiscPairs(std::span<const std::byte> bytes, std::string_view name);

/// Returns the content of a file of limn's own. Throws Error where the table has no texels or more than
/// kMostDiscTexels a side, or a value that is negative, no number, or above what the format keeps: 65504 for
/// half, else kLargestValue.
LIMN_API std::vector<std::byte> encodeMeasured(const AnisotropicTable& table,
                                               MeasuredFormat format = MeasuredFormat::half);

/// Writes such a file, which appears whole. Throws Error that begins with its name where it cannot be written
/// or the table cannot be encoded.
LIMN_API void writeMeasured(const std::filesystem::path& path, const AnisotropicTable& table,
                            MeasuredFormat format = MeasuredFormat::half);

}  // namespace limn::brdf
