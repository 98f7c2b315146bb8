// What a fuzzer's input can name but never reaches: other files, whose formats have fuzzers of their own. A
// picture is a small one of the size its PNG header states, so that loading goes on behind it.
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "core/scene_io/density_grid_file.h"
#include "core/scene_io/load.h"

namespace limn {

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t) {
  throw Error(fmt::format("{}: no such file", path.string()));
}

std::string readTextFile(const std::filesystem::path& path, std::uint64_t) {
  throw Error(fmt::format("{}: no such file", path.string()));
}

std::string readBeginning(const std::filesystem::path& path, std::uint64_t) {
  throw Error(fmt::format("{}: no such file", path.string()));
}

void writeFile(const std::filesystem::path& path, std::span<const std::byte>) {
  throw Error(fmt::format("{}: no such folder", path.string()));
}

Image8 readImage8Memory(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < 24) throw Error(name + ": not a picture");
  Image8 image{1 + std::to_integer<int>(bytes[19]) % 8, 1 + std::to_integer<int>(bytes[23]) % 8, {}};
  image.data.assign(static_cast<std::size_t>(image.width * image.height) * 4, 128);
  return image;
}

ImageChannel readFirstChannelMemory(std::span<const std::byte> bytes, const std::string& name,
                                    std::uint64_t) {
  const Image8 image = readImage8Memory(bytes, name);
  ImageChannel channel{image.width, image.height, 8, {}};
  channel.values.assign(static_cast<std::size_t>(image.width * image.height), 0.5f);
  channel.values.back() = static_cast<float>(std::to_integer<int>(bytes[19]));
  return channel;
}

namespace scene {

Environment loadEnvironment(const std::filesystem::path& file, std::vector<std::string>&) {
  throw Error(fmt::format("{}: no such file", file.string()));
}

DensityGrid readDensityGrid(const std::filesystem::path& file, const GridLimits&, const glm::dvec3&) {
  throw Error(fmt::format("{}: no such file", file.string()));
}

void setGrid(Medium&, DensityGrid) {}

}  // namespace scene
}  // namespace limn
