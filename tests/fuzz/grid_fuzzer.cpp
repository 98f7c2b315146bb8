// libFuzzer target of density grids: limn's side of what it asks of OpenVDB. One byte chooses between a
// message as limn-read-grid would send it, and a grid that the library has read without complaint: voxels,
// tiles, background and transform from the input. The reading itself is OpenVDB's, which crashes on damaged
// files; that is why it has a process of its own.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/scene_io/private/grid_message.h"
#include "core/scene_io/readers/vdb_grid.h"

namespace {

using limn::scene::DensityGrid;
using limn::scene::GridHeader;
using limn::scene::GridLimits;

constexpr GridLimits kLimits{.voxels = 1 << 12, .side = 64};

void require(bool condition) {
  if (!condition) std::abort();
}

/// Takes numbers off the input; zeros at its end.
class Input {
 public:
  explicit Input(std::span<const std::byte> bytes) : bytes_(bytes) {}
  bool empty() const { return bytes_.empty(); }
  template <class Number>
  Number take() {
    Number number{};
    const std::size_t count = std::min(sizeof number, bytes_.size());
    std::memcpy(&number, bytes_.data(), count);
    bytes_ = bytes_.subspan(count);
    return number;
  }
  std::span<const std::byte> rest() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

template <class Step>
void attempt(Step step) {
  try {
    step();
  } catch (const limn::Error& error) {
    require(std::strlen(error.what()) > 0);
  } catch (const openvdb::Exception&) {
    // main() of the reader makes it a refusal
  }
}

void check(const DensityGrid& grid) {
  const std::size_t count = static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y) *
                            static_cast<std::size_t>(grid.size.z);
  require(grid.values.size() == count && count > 0 && count <= kLimits.voxels);
  for (int axis = 0; axis < 3; ++axis) require(grid.size[axis] >= 1 && grid.size[axis] <= kLimits.side);
}

void message(std::span<const std::byte> bytes) {
  const DensityGrid grid = limn::scene::decodeGridMessage(bytes, kLimits);
  check(grid);
  for (const float v : grid.values) require(v >= 0 && v <= 1e30f);
}

openvdb::Coord coordinates(Input& input) {
  // Small ones, or any; ends of the range among them.
  const auto mode = input.take<std::uint8_t>();
  openvdb::Coord place;
  for (int axis = 0; axis < 3; ++axis) {
    if (mode % 4 == 0)
      place[axis] = input.take<std::int32_t>();
    else if (mode % 4 == 1)
      place[axis] = (mode & 4 ? INT32_MAX : INT32_MIN) + (mode & 4 ? -1 : 1) * input.take<std::uint8_t>();
    else
      place[axis] = input.take<std::int8_t>();
  }
  return place;
}

void grid(Input input) {
  const auto made = openvdb::FloatGrid::create(input.take<float>());
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();
  const auto scale = input.take<float>();
  for (int i = 0; i < 3; ++i) matrix(i, i) = scale;
  matrix(3, input.take<std::uint8_t>() % 3) = input.take<float>();
  matrix(0, 1) = input.take<std::int8_t>();
  made->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  for (int i = 0; i < 16 && !input.empty(); ++i) {
    const openvdb::Coord place = coordinates(input);
    const auto level = input.take<std::uint8_t>();
    if (level % 4 == 3)
      made->tree().addTile(1 + level / 4 % 3, place, input.take<float>(), (level & 64) != 0);
    else
      made->tree().setValue(place, input.take<float>());
  }
  const DensityGrid dense = limn::scene::denseGrid(*made, kLimits, glm::dvec3(0));
  check(dense);
  const GridHeader header = limn::scene::headerOf(dense);
  std::vector<std::byte> bytes(sizeof header + header.bytes);
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, dense.values.data(), header.bytes);
  message(bytes);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  openvdb::initialize();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data + 1, size - 1));
  if (data[0] % 2 == 0)
    attempt([&] { message(bytes); });
  else
    attempt([&] { grid(Input(bytes)); });
  return 0;
}
