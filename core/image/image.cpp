#include "core/image/image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn {
namespace {

/// The names as messages show them: those of a file may hold anything.
std::string listed(const std::vector<std::string>& channels) {
  return oneLine(fmt::format("{}", fmt::join(channels, ", ")));
}

void checkChannelNames(const std::vector<std::string>& channels) {
  if (channels.empty() || channels.size() > static_cast<std::size_t>(kMaxImageChannels)) {
    throw Error(fmt::format("image: {} channels, 1 to {} are accepted", channels.size(), kMaxImageChannels));
  }
  std::vector<std::string> sorted = channels;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.front().empty()) throw Error("image: a channel without a name");
  const auto repeated = std::adjacent_find(sorted.begin(), sorted.end());
  if (repeated != sorted.end())
    throw Error(fmt::format("image: two channels named '{}'", oneLine(*repeated)));
}

std::size_t checkedValueCount(std::int64_t width, std::int64_t height, std::size_t channels) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
    throw Error(fmt::format("image: size {}x{}, each side must be in 1..{}", width, height, kMaxImageSide));
  }
  if (width * height > kMaxImagePixels ||
      width * height * static_cast<std::int64_t>(channels) > kMaxImageValues) {
    throw Error(
        fmt::format("image: {}x{} pixels of {} channels, at most {} pixels and {} values are accepted", width,
                    height, channels, kMaxImagePixels, kMaxImageValues));
  }
  return static_cast<std::size_t>(width * height) * channels;
}

}  // namespace

Image::Image(int width, int height, std::vector<std::string> channels)
    : width_(width), height_(height), channels_(std::move(channels)) {
  checkChannelNames(channels_);
  data_.resize(checkedValueCount(width, height, channels_.size()));
}

Image Image::rgb(int width, int height) {
  return Image(width, height, {"R", "G", "B"});
}

std::optional<int> Image::findChannel(std::string_view name) const {
  const auto found = std::find(channels_.begin(), channels_.end(), name);
  if (found == channels_.end()) return std::nullopt;
  return static_cast<int>(found - channels_.begin());
}

int Image::channel(std::string_view name) const {
  const std::optional<int> found = findChannel(name);
  if (!found) throw Error(fmt::format("image: no channel '{}'; there are {}", name, listed(channels_)));
  return *found;
}

std::array<int, 3> Image::rgbChannels(std::string_view name) const {
  const std::optional<int> r = findChannel("R"), g = findChannel("G"), b = findChannel("B");
  if (r && g && b) return {*r, *g, *b};
  const std::optional<int> y = findChannel("Y");
  if (y) return {*y, *y, *y};
  if (channelCount() == 1) return {0, 0, 0};
  throw Error(fmt::format("{}: no channels R, G, B or Y; there are {}", name, listed(channels_)));
}

void Image::addChannel(std::string name, std::span<const float> values) {
  if (!values.empty() && values.size() != pixelCount()) {
    throw Error(
        fmt::format("image: channel '{}' has {} values for {} pixels", name, values.size(), pixelCount()));
  }
  std::vector<std::string> names = channels_;
  names.push_back(std::move(name));
  Image grown(width_, height_, std::move(names));
  const std::size_t old = channels_.size();
  for (std::size_t i = 0; i < pixelCount(); ++i) {
    float* target = grown.data_.data() + i * (old + 1);
    std::copy_n(data_.data() + i * old, old, target);
    if (!values.empty()) target[old] = values[i];
  }
  channels_ = std::move(grown.channels_);
  data_ = std::move(grown.data_);
}

Image Image::select(std::span<const std::string> names) const {
  std::vector<std::size_t> positions;
  for (const std::string& name : names) positions.push_back(static_cast<std::size_t>(channel(name)));
  Image result(width_, height_, std::vector<std::string>(names.begin(), names.end()));
  for (std::size_t i = 0; i < pixelCount(); ++i) {
    for (std::size_t c = 0; c < positions.size(); ++c) {
      result.data_[i * positions.size() + c] = data_[i * channels_.size() + positions[c]];
    }
  }
  result.metadata_ = metadata_;
  return result;
}

Image Image::select(std::initializer_list<std::string> names) const {
  return select(std::span<const std::string>(names.begin(), names.size()));
}

}  // namespace limn
