// Declares the protocol between the program limn-read-grid and the process that starts it: arguments one way,
// one message back.
//
//   limn-read-grid FILE MEMORY SECONDS VOXELS SIDE X Y Z
//
// MEMORY is in bytes, SECONDS in seconds; VOXELS and SIDE are those of GridLimits; X Y Z is the point of the
// file's world, in metres, relative to which the grid is placed.
//
// The message is a header in the machine's own byte order, then `bytes` bytes: the densities as floats, x
// fastest, or, when the file is refused, the reason. Nothing follows. The message is untrusted, because a
// damaged file may have taken over the program: every number is checked before it is used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/scene_io/density_grid_file.h"

namespace limn::scene {

struct GridHeader {
  static constexpr std::array<char, 8> expected{'l', 'i', 'm', 'n', 'g', 'r', 'i', 'd'};
  static constexpr std::uint32_t grid = 0, refusal = 1;

  std::array<char, 8> magic = expected;
  std::uint32_t kind = grid;
  std::array<std::int32_t, 3> size{};
  std::array<float, 16> worldToBox{};  ///< column-major
  std::uint64_t bytes = 0;
};
static_assert(std::is_trivially_copyable_v<GridHeader> && sizeof(GridHeader) == 96);

/// Returns the header that precedes a grid's densities, or a reason of refusal.
LIMN_API GridHeader headerOf(const DensityGrid& grid);
LIMN_API GridHeader headerOf(std::string_view reason);

/// Returns the size in bytes of the largest message that answers a request with these limits.
std::uint64_t largestGridMessage(const GridLimits& limits);

/// Returns the grid of a message. Throws Error, without the file's name, with the reason of a refusal, or
/// with what is wrong with the message or its densities.
LIMN_API DensityGrid decodeGridMessage(std::span<const std::byte> message, const GridLimits& limits);

}  // namespace limn::scene
