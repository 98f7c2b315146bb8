#include "core/brdf/merl_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "core/base/file.h"

namespace limn::brdf {
namespace {

using Header = std::array<std::int32_t, 3>;

constexpr std::array<double, 3> kScales{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr std::array<std::string_view, 3> kChannels{"red", "green", "blue"};

std::size_t fileSize(const glm::ivec3& size) {
  return sizeof(Header) + 3 * nodeCount(size) * sizeof(double);
}

std::string sizeText(const glm::ivec3& size) {
  return fmt::format("{} x {} x {}", size.x, size.y, size.z);
}

}  // namespace

TabulatedBrdf decodeMerl(std::span<const std::byte> bytes, std::string_view name, const glm::ivec3& size) {
  Header header{};
  if (bytes.size() < sizeof header)
    throw Error(
        fmt::format("{}: {} bytes, too short for a MERL BRDF of {}", name, bytes.size(), sizeText(size)));
  std::memcpy(header.data(), bytes.data(), sizeof header);
  if (const glm::ivec3 found(header[0], header[1], header[2]); found != size)
    throw Error(
        fmt::format("{}: not a MERL BRDF: {} nodes; {} are accepted", name, sizeText(found), sizeText(size)));
  if (bytes.size() != fileSize(size))
    throw Error(fmt::format("{}: {} bytes; a MERL BRDF of {} nodes has {}", name, bytes.size(),
                            sizeText(size), fileSize(size)));

  TabulatedBrdf table{.size = size, .values = std::vector<glm::vec3>(nodeCount(size))};
  const std::byte* at = bytes.data() + sizeof header;
  for (int channel = 0; channel < 3; ++channel) {
    const auto c = static_cast<std::size_t>(channel);
    for (std::size_t node = 0; node < table.values.size(); ++node, at += sizeof(double)) {
      double number = 0;
      std::memcpy(&number, at, sizeof number);
      const double f = number * kScales[c];
      if (!std::isfinite(number) || f > kLargestValue)
        throw Error(fmt::format(
            "{}: {} at node {} of {}: f from 0 to {:g}, or a negative number for none, is accepted", name,
            number, node, kChannels[c], kLargestValue));
      table.values[node][channel] = number < 0 ? -1 : static_cast<float>(f);
    }
  }
  if (!fillInvalid(table)) throw Error(fmt::format("{}: a MERL BRDF without any measured node", name));
  return table;
}

std::vector<std::byte> encodeMerl(const TabulatedBrdf& table) {
  std::vector<std::byte> bytes(fileSize(table.size));
  const Header header{table.size.x, table.size.y, table.size.z};
  std::memcpy(bytes.data(), header.data(), sizeof header);
  std::byte* at = bytes.data() + sizeof header;
  for (int channel = 0; channel < 3; ++channel)
    for (const glm::vec3& f : table.values) {
      const double number = static_cast<double>(f[channel]) / kScales[static_cast<std::size_t>(channel)];
      std::memcpy(at, &number, sizeof number);
      at += sizeof number;
    }
  return bytes;
}

void writeMerl(const std::filesystem::path& path, const TabulatedBrdf& table) {
  if (table.size != kMerlSize)
    throw Error(fmt::format("{}: a table of {} nodes; a MERL BRDF has {}", path.string(),
                            sizeText(table.size), sizeText(kMerlSize)));
  writeFile(path, encodeMerl(table));
}

}  // namespace limn::brdf
