#include "core/scene_io/private/grid_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene_io/private/refusal.h"

namespace limn::scene {
namespace {

std::uint64_t voxels(const std::array<std::int32_t, 3>& size, const GridLimits& limits) {
  std::uint64_t count = 1;
  for (const std::int32_t side : size) {
    if (side < 1 || side > limits.side) return 0;
    count *= static_cast<std::uint64_t>(side);
    if (count > limits.voxels) return 0;
  }
  return count;
}

}  // namespace

GridHeader headerOf(const DensityGrid& grid) {
  GridHeader header;
  for (int axis = 0; axis < 3; ++axis) header.size[static_cast<std::size_t>(axis)] = grid.size[axis];
  std::memcpy(header.worldToBox.data(), glm::value_ptr(grid.worldToBox), sizeof header.worldToBox);
  header.bytes = grid.values.size() * sizeof(float);
  return header;
}

GridHeader headerOf(std::string_view reason) {
  GridHeader header;
  header.kind = GridHeader::refusal;
  header.bytes = std::min<std::uint64_t>(reason.size(), kMostReasonBytes);
  return header;
}

std::uint64_t largestGridMessage(const GridLimits& limits) {
  return sizeof(GridHeader) + std::max<std::uint64_t>(limits.voxels * sizeof(float), kMostReasonBytes);
}

DensityGrid decodeGridMessage(std::span<const std::byte> message, const GridLimits& limits) {
  GridHeader header;
  const auto refuse = [] { throw Error("not an OpenVDB file that can be read (reading it gave no grid)"); };
  if (message.size() < sizeof header) refuse();
  std::memcpy(&header, message.data(), sizeof header);
  const std::span<const std::byte> rest = message.subspan(sizeof header);
  if (header.magic != GridHeader::expected || header.bytes != rest.size()) refuse();
  if (header.kind == GridHeader::refusal) {
    const std::string reason =
        oneLine({reinterpret_cast<const char*>(rest.data()), rest.size()}, kMostReasonBytes);
    if (!reason.empty()) throw Error(reason);
  }
  const std::uint64_t count = voxels(header.size, limits);
  if (header.kind != GridHeader::grid || count == 0 || rest.size() != count * sizeof(float)) refuse();

  DensityGrid grid;
  grid.size = {header.size[0], header.size[1], header.size[2]};
  for (const float v : header.worldToBox)
    if (!(std::abs(v) <= 1e30f)) refuse();
  grid.worldToBox = glm::make_mat4(header.worldToBox.data());
  grid.values.resize(count);
  std::memcpy(grid.values.data(), rest.data(), rest.size());
  for (const float v : grid.values)
    if (!(v >= 0 && v <= 1e30f)) throw Error(fmt::format("a density of {}; 0 to 1e30 is accepted", v));
  return grid;
}

}  // namespace limn::scene
