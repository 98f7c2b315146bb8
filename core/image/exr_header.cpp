#include "core/image/private/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "core/image/image.h"

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
  bool atEnd() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

/// Channels of a list: each has a name and sixteen bytes more, an empty name ends it. Nothing where the list
/// ends earlier or later than its attribute.
std::optional<std::uint64_t> channelCount(Cursor list) {
  for (std::uint64_t count = 0;; ++count) {
    const auto name = list.text();
    if (name && name->empty()) return list.atEnd() ? std::optional(count) : std::nullopt;
    if (!name || !list.take(16)) return std::nullopt;
  }
}

bool isStringVector(Cursor list) {
  while (!list.atEnd()) {
    const auto length = list.number();
    if (!length || !list.take(*length)) return false;
  }
  return true;
}

bool isPreview(Cursor picture) {
  const auto width = picture.number(), height = picture.number();
  if (!width || !height) return false;
  const std::uint64_t pixels = std::uint64_t{*width} * *height;
  return pixels < kMaxTileValues && picture.take(4 * pixels) && picture.atEnd();
}

/// Whether a value of one of the predefined types is as long as its attribute says. The library reads such a
/// value by its type, whatever the length: everything behind one that is shorter or longer is read askew, and
/// the length of the next attribute may be any number.
bool fillsItsAttribute(std::string_view type, std::span<const std::byte> value) {
  constexpr std::pair<std::string_view, std::size_t> sizes[] = {{"box2f", 16},
                                                                {"box2i", 16},
                                                                {"chromaticities", 32},
                                                                {"compression", 1},
                                                                {"deepImageState", 1},
                                                                {"double", 8},
                                                                {"envmap", 1},
                                                                {"float", 4},
                                                                {"int", 4},
                                                                {"keycode", 28},
                                                                {"lineOrder", 1},
                                                                {"m33d", 72},
                                                                {"m33f", 36},
                                                                {"m44d", 128},
                                                                {"m44f", 64},
                                                                {"rational", 8},
                                                                {"tiledesc", 9},
                                                                {"timecode", 8},
                                                                {"v2d", 16},
                                                                {"v2f", 8},
                                                                {"v2i", 8},
                                                                {"v3d", 24},
                                                                {"v3f", 12},
                                                                {"v3i", 12}};
  if (type == "chlist") return channelCount(Cursor(value)).has_value();
  if (type == "stringvector") return isStringVector(Cursor(value));
  if (type == "preview") return isPreview(Cursor(value));
  const auto known = std::ranges::find(sizes, type, [](const auto& size) { return size.first; });
  return known == std::end(sizes) || known->second == value.size();
}

/// Returns what is wrong with the window of pixels that a file holds, or nothing.
std::string windowProblem(Cursor window) {
  std::int64_t corners[4];
  for (std::int64_t& corner : corners) {
    const auto number = window.number();
    if (!number) return "truncated or damaged OpenEXR header";
    corner = static_cast<std::int32_t>(*number);
  }
  const std::int64_t width = corners[2] - corners[0] + 1, height = corners[3] - corners[1] + 1;
  if (width <= kMaxImageSide && height <= kMaxImageSide) return {};
  return fmt::format("{}x{} pixels; at most {} per side are accepted", width, height, kMaxImageSide);
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
      if (!value || !fillsItsAttribute(*type, *value)) return tooShort;
      if (*name == "channels") channels = std::max(channels, channelCount(Cursor(*value)).value_or(0));
      if (*name == "dataWindow")
        if (std::string problem = windowProblem(Cursor(*value)); !problem.empty()) return problem;
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
