// Density grids from files: asks limn-read-grid (core/scene_io/readers) and checks what it answers.
#include "core/scene_io/density_grid_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/base/error.h"
#include "core/base/helper.h"
#include "core/scene_io/private/grid_message.h"

namespace limn::scene {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  std::string text = fmt::format("{}: {}", file.string(), what);
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, ' ');
  throw Error(text.substr(0, 600));
}

void checkFile(const std::filesystem::path& file, const GridLimits& limits) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) fail(file, fmt::format("cannot be read: {}", error.message()));
  if (bytes > limits.fileBytes)
    fail(file, fmt::format("{} bytes; at most {} are accepted", bytes, limits.fileBytes));
}

HelperAnswer ask(const std::filesystem::path& file, const GridLimits& limits, const glm::dvec3& origin) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(limits.time).count();
  return runHelper("limn-read-grid",
                   {file.string(), fmt::format("{}", limits.memory), fmt::format("{}", seconds),
                    fmt::format("{}", limits.voxels), fmt::format("{}", limits.side),
                    fmt::format("{}", origin.x), fmt::format("{}", origin.y), fmt::format("{}", origin.z)},
                   {.time = limits.time, .answerBytes = largestGridMessage(limits)});
}

}  // namespace

DensityGrid readDensityGrid(const std::filesystem::path& file, const GridLimits& limits,
                            const glm::dvec3& origin) {
  checkFile(file, limits);
  try {
    const HelperAnswer answer = ask(file, limits, origin);
    if (!answer.failure.empty())
      throw Error(fmt::format("not an OpenVDB file that can be read ({})", answer.failure));
    return decodeGridMessage(answer.bytes, limits);
  } catch (const Error& error) {
    fail(file, error.what());
  }
}

}  // namespace limn::scene
