// How the program limn-read-grid and the process that asked it speak: arguments one way, one message back.
//
//   limn-read-grid FILE MEMORY SECONDS VOXELS SIDE X Y Z
//
// These are bytes, seconds, the numbers of GridLimits, and the place in the file's world, in metres, from
// which the grid is placed.
//
// The message is a header in the machine's own byte order, then `bytes` bytes: the densities as floats, x
// fastest, or, where the file is refused, the reason. Nothing follows. It counts as untrusted, since a
// damaged file may have taken the program over: every number is checked before it is used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/scene/density_grid.h"

namespace limn::scene {

struct GridHeader {
  static constexpr std::array<char, 8> expected{'l', 'i', 'm', 'n', 'g', 'r', 'i', 'd'};
  static constexpr std::uint32_t grid = 0, refusal = 1;

  std::array<char, 8> magic = expected;
  std::uint32_t kind = grid;
  std::array<std::int32_t, 3> size{};
  std::array<float, 16> worldToBox{};  ///< column after column
  std::uint64_t bytes = 0;
};
static_assert(std::is_trivially_copyable_v<GridHeader> && sizeof(GridHeader) == 96);

/// The header that goes before a grid's densities, or before a reason of that many bytes.
LIMN_API GridHeader headerOf(const DensityGrid& grid);
LIMN_API GridHeader headerOf(std::string_view reason);

/// The largest message that answers a question with these limits.
std::uint64_t largestGridMessage(const GridLimits& limits);

/// The grid of a message. Throws Error without the file's name: with the reason of a refusal, or saying what
/// is wrong with the message or with the densities in it.
LIMN_API DensityGrid decodeGridMessage(std::span<const std::byte> message, const GridLimits& limits);

}  // namespace limn::scene
