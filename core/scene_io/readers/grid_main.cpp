// limn-read-grid: reads one grid of an OpenVDB file, in a process of its own with limits of its own, and
// answers as core/scene_io/private/grid_message.h says. liblimn starts it.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <limits>
#include <new>
#include <string_view>

#include "core/base/error.h"
#include "core/scene_io/private/grid_message.h"
#include "core/scene_io/readers/confine.h"
#include "core/scene_io/readers/vdb_grid.h"

namespace {

using namespace limn::scene;

bool answer(const GridHeader& header, std::span<const std::byte> content) {
  return limn::writeAnswer(std::as_bytes(std::span(&header, 1))) &&
         limn::writeAnswer(content.first(header.bytes));
}

bool refuse(std::string_view reason) {
  return answer(headerOf(reason), std::as_bytes(std::span(reason)));
}

bool work(const char* file, std::uint64_t memory, const GridLimits& limits, const glm::dvec3& origin) {
  try {
    const DensityGrid grid = readVdbGrid(file, limits, origin);
    return answer(headerOf(grid), std::as_bytes(std::span(grid.values)));
  } catch (const limn::Error& error) {
    return refuse(error.what());
  } catch (const std::bad_alloc&) {
    return refuse(
        fmt::format("not an OpenVDB file that can be read (it asks for more memory than the {} MiB allowed)",
                    memory >> 20));
  } catch (const std::exception& exception) {
    return refuse(fmt::format("not an OpenVDB file that can be read ({})", exception.what()));
  }
}

}  // namespace

int main(int count, char** arguments) {
  std::uint64_t numbers[4] = {};
  glm::dvec3 origin(0);
  bool understood = count == 9;
  const auto read = [&](int argument, auto& number) {
    if (!understood) return;
    const std::string_view text = arguments[argument];
    understood = std::from_chars(text.data(), text.data() + text.size(), number).ec == std::errc();
  };
  for (int i = 0; i < 4; ++i) read(2 + i, numbers[i]);
  for (int i = 0; i < 3; ++i) read(6 + i, origin[i]);
  if (!understood || numbers[3] > std::numeric_limits<int>::max()) {
    std::fprintf(stderr, "usage: limn-read-grid FILE MEMORY SECONDS VOXELS SIDE X Y Z\n");
    return 2;
  }
  if (!limn::confine(numbers[0], static_cast<unsigned>(numbers[1]))) return 3;
  // Each thread would take addresses for a stack and a heap of its own.
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  GridLimits limits;
  limits.voxels = numbers[2];
  limits.side = static_cast<int>(numbers[3]);
  // What the library made of a damaged file is not taken down.
  _exit(work(arguments[1], numbers[0], limits, origin) ? 0 : 1);
}
