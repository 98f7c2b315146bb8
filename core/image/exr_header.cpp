#include "core/image/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

namespace limn {
namespace {

/// Takes a header apart from its beginning; every step fails at the end of the file.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::optional<std::span<const std::byte>> take(std::uint64_t count) {
    if (count > rest_.size()) return std::nullopt;
    const std::span<const std::byte> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  std::optional<std::uint32_t> number() {
    const auto four = take(4);
    if (!four) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 4; i > 0; --i) value = value << 8 | std::to_integer<std::uint32_t>((*four)[i - 1]);
    return value;
  }
  /// Text up to a zero byte.
  std::optional<std::string_view> text() {
    const std::string_view all(reinterpret_cast<const char*>(rest_.data()), rest_.size());
    const std::size_t end = all.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    rest_ = rest_.subspan(end + 1);
    return all.substr(0, end);
  }

 private:
  std::span<const std::byte> rest_;
};

/// Channels of a list: each has a name and sixteen bytes more, an empty name ends it.
std::uint64_t channelCount(std::span<const std::byte> list) {
  Cursor cursor(list);
  std::uint64_t count = 0;
  for (auto name = cursor.text(); name && !name->empty() && cursor.take(16); name = cursor.text()) ++count;
  return count;
}

}  // namespace

std::string exrHeaderProblem(std::span<const std::byte> bytes) {
  constexpr std::uint32_t severalParts = 0x1000;
  const std::string tooShort = "truncated or damaged OpenEXR header";
  Cursor cursor(bytes);
  const auto magic = cursor.number(), version = cursor.number();
  if (!magic || !version) return tooShort;
  for (bool first = true;; first = false) {
    auto name = cursor.text();
    if (!name) return tooShort;
    if (name->empty() && !first && (*version & severalParts) != 0) return {};  // of the list of headers
    std::uint64_t width = 0, height = 0, channels = 0;
    while (!name->empty()) {
      const auto type = cursor.text();
      const auto size = type ? cursor.number() : std::nullopt;
      const auto value = size ? cursor.take(*size) : std::nullopt;
      if (!value) return tooShort;
      if (*name == "channels") channels = std::max(channels, channelCount(*value));
      if (*name == "tiles") {
        Cursor tile(*value);
        const auto w = tile.number(), h = tile.number();
        if (!w || !h) return tooShort;
        width = std::max<std::uint64_t>(width, *w);
        height = std::max<std::uint64_t>(height, *h);
      }
      name = cursor.text();
      if (!name) return tooShort;
    }
    if (width * height > kMaxTileValues || width * height * channels > kMaxTileValues)
      return fmt::format("tiles of {}x{} pixels of {} channels; at most {} values are accepted", width,
                         height, channels, kMaxTileValues);
    if ((*version & severalParts) == 0) return {};
  }
}

}  // namespace limn
