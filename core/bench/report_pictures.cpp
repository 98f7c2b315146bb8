#include "core/bench/private/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::bench {
namespace fs = std::filesystem;
namespace {

std::size_t size(int value) {
  return static_cast<std::size_t>(value);
}

double luminance(const Image& image, int x, int y, const std::array<int, 3>& rgb) {
  return glsl::luminance({image.at(x, y, rgb[0]), image.at(x, y, rgb[1]), image.at(x, y, rgb[2])});
}

/// The picture if it lies in the folder, whatever the row says; "" otherwise.
fs::path inside(const fs::path& folder, const std::string& file) {
  const fs::path path = fileInFolder(folder, file);
  return path.extension() == ".png" ? path : fs::path();
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Image cut(const Image& image, const Window& w) {
  Image part = Image::rgb(w.width, w.height);
  const std::array<int, 3> rgb = image.rgbChannels();
  for (int y = 0; y < w.height; ++y)
    for (int x = 0; x < w.width; ++x)
      for (int c = 0; c < 3; ++c) part.at(x, y, c) = image.at(w.x + x, w.y + y, rgb[size(c)]);
  return part;
}

/// Means of blocks, of light rather than of display values.
Image reduced(const Image& image, int factor) {
  Image small = Image::rgb(std::max(1, image.width() / factor), std::max(1, image.height() / factor));
  const std::array<int, 3> rgb = image.rgbChannels();
  for (int y = 0; y < small.height(); ++y) {
    for (int x = 0; x < small.width(); ++x) {
      const int right = std::min(image.width(), (x + 1) * factor);
      const int bottom = std::min(image.height(), (y + 1) * factor);
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (int v = y * factor; v < bottom; ++v)
          for (int u = x * factor; u < right; ++u) sum += image.at(u, v, rgb[size(c)]);
        small.at(x, y, c) = sum / static_cast<float>((right - x * factor) * (bottom - y * factor));
      }
    }
  }
  return small;
}

/// Sums over every window of that side, by a summed-area table: index y * (width - side + 1) + x.
std::vector<double> windowSums(std::span<const double> values, int width, int height, int side) {
  std::vector<double> table(size(width + 1) * size(height + 1));
  const auto at = [&](int x, int y) -> double& { return table[size(y) * size(width + 1) + size(x)]; };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      at(x + 1, y + 1) = values[size(y) * size(width) + size(x)] + at(x, y + 1) + at(x + 1, y) - at(x, y);
  std::vector<double> sums;
  for (int y = 0; y + side <= height; ++y)
    for (int x = 0; x + side <= width; ++x)
      sums.push_back(at(x + side, y + side) - at(x, y + side) - at(x + side, y) + at(x, y));
  return sums;
}

}  // namespace

WindowChooser::WindowChooser(const Image& reference)
    : reference_(reference), sum_(reference.pixelCount()), squares_(reference.pixelCount()) {}

void WindowChooser::add(const Image& picture) {
  if (picture.width() != reference_.width() || picture.height() != reference_.height()) return;
  ++pictures_;
  const std::array<int, 3> rgb = picture.rgbChannels(), referenceRgb = reference_.rgbChannels();
  std::size_t i = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x, ++i) {
      const double error = luminance(picture, x, y, rgb) - luminance(reference_, x, y, referenceRgb);
      sum_[i] += error;
      squares_[i] += error * error;
    }
  }
}

std::vector<double> WindowChooser::variances() const {
  std::vector<double> result = squares_;
  if (pictures_ < 2) return result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] -= sum_[i] * sum_[i] / pictures_;
  return result;
}

std::vector<Window> WindowChooser::choose(int count) const {
  const int width = reference_.width(), height = reference_.height();
  const int shorter = std::min(width, height);
  constexpr int kSmallest = 16, kLargest = 64;
  if (pictures_ == 0 || shorter < kSmallest) return {};
  const int side = std::clamp(shorter / 6, kSmallest, kLargest);
  const std::vector<double> sums = windowSums(variances(), width, height, side);
  const int columns = width - side + 1;
  std::vector<Window> chosen;
  while (static_cast<int>(chosen.size()) < count) {
    double best = -1;
    Window window;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const int x = static_cast<int>(i) % columns, y = static_cast<int>(i) / columns;
      const bool apart = std::ranges::all_of(chosen, [&](const Window& other) {
        return std::abs(x - other.x) >= side || std::abs(y - other.y) >= side;
      });
      if (!apart || sums[i] <= best) continue;
      best = sums[i];
      window = {x, y, side, side};
    }
    if (best < 0) break;
    chosen.push_back(window);
  }
  return chosen;
}

EmbeddedPictures::EmbeddedPictures(const fs::path& folder, std::span<const std::string> files,
                                   std::uintmax_t budget)
    : folder_(folder) {
  std::uintmax_t bytes = 0;
  for (const std::string& file : std::set<std::string>(files.begin(), files.end())) {
    if (const fs::path path = inside(folder_, file); !path.empty()) bytes += fs::file_size(path);
  }
  constexpr std::uintmax_t kWebp = 5, kShrinks = 4;  // of half the width and height: a quarter
  compressed_ = bytes > budget;
  if (compressed_) bytes /= kWebp;
  for (; bytes > budget; bytes /= kShrinks) reduction_ *= 2;
}

Image EmbeddedPictures::read(const std::string& file) const {
  const fs::path path = inside(folder_, file);
  try {
    return path.empty() ? Image() : readImage(path);
  } catch (const Error&) {
    return {};  // a broken picture takes no report with it
  }
}

const Image& EmbeddedPictures::decoded(const std::string& file) {
  if (file != decodedFile_) {
    decoded_ = read(file);
    decodedFile_ = file;
  }
  return decoded_;
}

int EmbeddedPictures::add(const std::string& name, Kind kind, const char* type,
                          std::span<const std::uint8_t> file) {
  positions_[static_cast<std::size_t>(kind)].push_back(uris_.size());
  uris_.push_back(fmt::format("data:image/{};base64,{}", type, base64(file)));
  return known_[name] = static_cast<int>(uris_.size()) - 1;
}

int EmbeddedPictures::whole(const std::string& file) {
  if (const auto found = known_.find(file); found != known_.end()) return found->second;
  const fs::path path = inside(folder_, file);
  if (path.empty()) return known_[file] = -1;
  if (compressed_) {
    const Image& image = decoded(file);
    if (image.empty()) return known_[file] = -1;
    constexpr int kMostSide = 16383;  // of a WebP
    const int longest = std::max(image.width(), image.height());
    const int factor = std::max(reduction_, (longest + kMostSide - 1) / kMostSide);
    return add(file, Kind::whole, "webp", encodeWebp(factor > 1 ? reduced(image, factor) : image, file));
  }
  const std::string png = readTextFile(path);
  if (!png.starts_with("\x89PNG")) return known_[file] = -1;
  return add(file, Kind::whole, "png", {reinterpret_cast<const std::uint8_t*>(png.data()), png.size()});
}

int EmbeddedPictures::thumbnail(const std::string& file) {
  const std::string name = file + "#thumbnail";
  if (const auto found = known_.find(name); found != known_.end()) return found->second;
  const Image& image = decoded(file);
  if (image.empty()) return known_[name] = -1;
  const int factor = (std::max(image.width(), image.height()) + kThumbnail - 1) / kThumbnail;
  return add(name, Kind::thumbnail, "webp", encodeWebp(reduced(image, factor), name));
}

int EmbeddedPictures::window(const std::string& file, const Window& w) {
  const std::string name = fmt::format("{}#{},{},{},{}", file, w.x, w.y, w.width, w.height);
  if (const auto found = known_.find(name); found != known_.end()) return found->second;
  const Image& image = decoded(file);
  if (image.empty() || w.x < 0 || w.y < 0 || w.x + w.width > image.width() || w.y + w.height > image.height())
    return known_[name] = -1;
  return add(name, Kind::window, "png", encodePng(cut(image, w), name));
}

std::string EmbeddedPictures::elements() const {
  std::string text;
  for (const std::vector<std::size_t>& positions : positions_)
    for (const std::size_t i : positions)
      text += fmt::format("<script type=\"text/plain\" id=\"picture-{}\">{}</script>\n", i, uris_[i]);
  return text;
}

}  // namespace limn::bench
