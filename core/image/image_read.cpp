// Reading picture files. They are read whole and decoded in memory: WebP by libwebp, others by the library of
// core/image/files.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "core/image/private/image_codec.h"
#include "core/image/private/image_files.h"
#include "core/image/private/image_format.h"
#include "core/image/private/webp.h"
#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

/// What any file may unfold to, and what for each of its bytes beyond that. Pictures of the world stay below
/// 30; deflate reaches 1032 where all is the same.
constexpr std::int64_t kUnfoldedBytes = std::int64_t{1} << 28, kUnfoldedRatio = 256;

const char* decoderName(ImageFormat format) {
  switch (format) {
    case ImageFormat::exr:
      return "openexr";
    case ImageFormat::hdr:
      return "hdr";
    case ImageFormat::png:
      return "png";
    case ImageFormat::jpeg:
      return "jpeg";
  }
  return "";
}

/// Throws Error where a picture of a file of `file` bytes exceeds the limits.
void checkSize(std::int64_t width, std::int64_t height, std::int64_t channels, std::size_t file,
               const std::string& name) {
  if (width < 1 || height < 1 || channels < 1 || width > kMaxImageSide || height > kMaxImageSide ||
      channels > kMaxImageChannels || width * height > kMaxImagePixels ||
      width * height * channels > kMaxReadValues) {
    throw Error(fmt::format(
        "{}: {}x{} pixels of {} channels; at most {} per side, {} pixels, {} channels, {} values are "
        "accepted",
        name, width, height, channels, kMaxImageSide, kMaxImagePixels, kMaxImageChannels, kMaxReadValues));
  }
  const std::int64_t bytes = width * height * channels * std::int64_t{sizeof(float)};
  if (bytes > kUnfoldedBytes && bytes / kUnfoldedRatio > static_cast<std::int64_t>(file)) {
    throw Error(fmt::format(
        "{}: {}x{} pixels of {} channels in {} bytes; more than {} MiB of values are accepted from "
        "files of at least a {}th of that",
        name, width, height, channels, file, kUnfoldedBytes >> 20, kUnfoldedRatio));
  }
}

/// An opened file whose size has been checked against the limits; nothing of that size is allocated yet.
class Picture {
 public:
  Picture(std::span<const std::byte> bytes, const std::string& name)
      : name_(name), format_(detectImageFormat(bytes, name)) {
    const std::string problem = imageFileProblem(bytes, format_);
    if (!problem.empty()) fail(problem);
    decoder_ = image_files::library().open(bytes, decoderName(format_), name);
    const image_files::Header& header = decoder_->header();
    // Offsets of a PNG are those of a page that it is printed on.
    window_ = format_ == ImageFormat::exr ? header.whole : header.stored;
    if (header.deep) fail("deep and volume pictures are not accepted");
    for (const image_files::Window& window : {header.stored, window_})
      checkSize(window.width, window.height, header.channels, bytes.size(), name);
    // Elsewhere it is a note beside the picture, which glTF ignores; here it is the order of what is stored.
    if (format_ == ImageFormat::hdr) orientation_ = header.orientation;
    if (orientation_ > 4)
      fail("a size that begins with X (columns); one that begins with -Y or +Y is accepted");
  }

  /// Of the whole picture: an EXR may hold a part of it, or more than it.
  int width() const { return window_.width; }
  int height() const { return window_.height; }
  const image_files::Header& header() const { return decoder_->header(); }
  bool isSrgb() const { return format_ == ImageFormat::png || format_ == ImageFormat::jpeg; }
  ImageFormat format() const { return format_; }

  void read(image_files::Values values, void* target) { readFirst(header().channels, values, target); }
  /// Leaves what the file does not hold as it is.
  void readFirst(int channels, image_files::Values values, void* target) {
    const image_files::Window& stored = header().stored;
    if (stored == window_) return readStored(channels, values, target);
    const std::size_t pixelBytes = bytesOfPixel(channels, values);
    std::vector<std::byte> all(static_cast<std::size_t>(stored.width) *
                               static_cast<std::size_t>(stored.height) * pixelBytes);
    readStored(channels, values, all.data());
    const int left = std::max(stored.x, window_.x), top = std::max(stored.y, window_.y);
    const int right = std::min(stored.x + stored.width, window_.x + window_.width);
    const int bottom = std::min(stored.y + stored.height, window_.y + window_.height);
    if (left >= right) return;
    for (int y = top; y < bottom; ++y) {
      const auto startIn = [&](const image_files::Window& window) {
        return (static_cast<std::size_t>(y - window.y) * static_cast<std::size_t>(window.width) +
                static_cast<std::size_t>(left - window.x)) *
               pixelBytes;
      };
      std::memcpy(static_cast<std::byte*>(target) + startIn(window_), all.data() + startIn(stored),
                  static_cast<std::size_t>(right - left) * pixelBytes);
    }
  }

 private:
  static std::size_t bytesOfPixel(int channels, image_files::Values values) {
    return static_cast<std::size_t>(channels) * (values == image_files::Values::floats ? sizeof(float) : 1);
  }

  void readStored(int channels, image_files::Values values, void* target) {
    decoder_->read(channels, values, target);
    turn(static_cast<std::byte*>(target), bytesOfPixel(channels, values));
  }

  /// Moves pixels from where the file has them to where they are seen, which decoders leave to their caller.
  void turn(std::byte* pixels, std::size_t pixelBytes) const {
    const bool fromBelow = orientation_ == 3 || orientation_ == 4;
    const bool fromTheRight = orientation_ == 2 || orientation_ == 3;
    const auto width = static_cast<std::size_t>(header().stored.width),
               height = static_cast<std::size_t>(header().stored.height);
    const auto pixel = [&](std::size_t x, std::size_t y) { return pixels + (y * width + x) * pixelBytes; };
    for (std::size_t y = 0; fromBelow && y < height / 2; ++y)
      std::swap_ranges(pixel(0, y), pixel(width, y), pixel(0, height - 1 - y));
    for (std::size_t y = 0; fromTheRight && y < height; ++y)
      for (std::size_t x = 0; x < width / 2; ++x)
        std::swap_ranges(pixel(x, y), pixel(x + 1, y), pixel(width - 1 - x, y));
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(fmt::format("{}: {}", name_, reasonOf(reason)));
  }

  std::string name_;
  ImageFormat format_;
  std::unique_ptr<image_files::Decoder> decoder_;
  image_files::Window window_;
  int orientation_ = 1;
};

std::vector<std::string> channelNames(const Picture& picture) {
  if (!picture.isSrgb()) return picture.header().names;
  switch (picture.header().channels) {
    case 1:
      return {"Y"};
    case 2:
      return {"Y", "A"};
    case 3:
      return {"R", "G", "B"};
    default:
      return {"R", "G", "B", "A"};
  }
}

void decodeSrgb(Image& image) {
  const std::size_t channels = static_cast<std::size_t>(image.channelCount());
  const std::size_t colours = channels == 2 || channels == 4 ? channels - 1 : channels;
  std::span<float> data = image.data();
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (i % channels < colours) data[i] = glsl::srgb_decode(data[i]);
  }
}

/// A still WebP as it is stored, and whether its alpha says anything.
std::pair<Image8, bool> decodeWebp8(std::span<const std::byte> bytes, const std::string& name) {
  const WebpHeader header = readWebpHeader(bytes, name);
  checkSize(header.width, header.height, 4, bytes.size(), name);
  Image8 image{header.width, header.height, {}};
  image.data.resize(4 * static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height));
  decodeWebp(bytes, header, image.data, name);
  return {std::move(image), header.alpha};
}

Image decodeLinearWebp(std::span<const std::byte> bytes, const std::string& name) {
  const auto [stored, alpha] = decodeWebp8(bytes, name);
  Image image(stored.width, stored.height, {"R", "G", "B", "A"});
  for (std::size_t i = 0; i < stored.data.size(); ++i)
    image.data()[i] = static_cast<float>(stored.data[i]) / 255.0f;
  decodeSrgb(image);
  return alpha ? std::move(image) : image.select({"R", "G", "B"});
}

Image decode(std::span<const std::byte> bytes, const std::string& name) {
  if (isWebp(bytes)) return decodeLinearWebp(bytes, name);
  Picture picture(bytes, name);
  const std::vector<std::string> names = channelNames(picture);
  if (names.size() != static_cast<std::size_t>(picture.header().channels)) {
    throw Error(fmt::format("{}: {} channels without names", name, picture.header().channels));
  }
  Image image = [&] {
    try {
      return Image(picture.width(), picture.height(), names);
    } catch (const Error& failure) {
      throw Error(fmt::format("{}: {}", name, failure.what()));
    }
  }();
  picture.read(image_files::Values::floats, image.data().data());
  if (picture.isSrgb()) decodeSrgb(image);
  for (const auto& [key, text] : picture.header().texts)
    if (key.starts_with(kMetadataPrefix)) image.metadata()[key.substr(std::strlen(kMetadataPrefix))] = text;
  return image;
}

Image8 decode8(std::span<const std::byte> bytes, const std::string& name) {
  if (isWebp(bytes)) return decodeWebp8(bytes, name).first;
  Picture picture(bytes, name);
  const std::size_t channels = static_cast<std::size_t>(picture.header().channels);
  if (!picture.isSrgb() || channels > 4) {
    throw Error(fmt::format("{}: an 8-bit texture must be PNG, JPEG or WebP with 1 to 4 channels", name));
  }
  const std::size_t pixels =
      static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  std::vector<std::uint8_t> raw(pixels * channels);
  picture.read(image_files::Values::bytes, raw.data());
  Image8 image{picture.width(), picture.height(), {}};
  if (channels == 4) {
    image.data = std::move(raw);
    return image;
  }
  image.data.resize(pixels * 4);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* source = &raw[i * channels];
    std::uint8_t* target = &image.data[i * 4];
    for (std::size_t c = 0; c < 3; ++c) target[c] = source[channels == 3 ? c : 0];
    target[3] = channels == 2 ? source[1] : 255;
  }
  return image;
}

ImageChannel decodeFirstChannel(std::span<const std::byte> bytes, const std::string& name,
                                std::uint64_t mostPixels) {
  const Error refusal(fmt::format("{}: a PNG or an EXR is accepted", name));
  if (isWebp(bytes)) throw refusal;  // it has a decoder of its own
  Picture picture(bytes, name);
  if (picture.format() != ImageFormat::png && picture.format() != ImageFormat::exr) throw refusal;
  const int width = picture.width(), height = picture.height();
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (pixels > mostPixels)
    throw Error(fmt::format("{}: {}x{} pixels; at most {} are accepted", name, width, height, mostPixels));
  ImageChannel channel{width, height, 8 * picture.header().valueBytes, {}};
  channel.values.resize(static_cast<std::size_t>(pixels));
  picture.readFirst(1, image_files::Values::floats, channel.values.data());
  return channel;
}

}  // namespace

Image readImageMemory(std::span<const std::byte> bytes, const std::string& name) {
  return guarded(name, [&] { return decode(bytes, name); });
}

Image readImage(const std::filesystem::path& path) {
  return readImageMemory(readFile(path), path.string());
}

ImageChannel readFirstChannelMemory(std::span<const std::byte> bytes, const std::string& name,
                                    std::uint64_t mostPixels) {
  return guarded(name, [&] { return decodeFirstChannel(bytes, name, mostPixels); });
}

Image8 readImage8Memory(std::span<const std::byte> bytes, const std::string& name) {
  return guarded(name, [&] { return decode8(bytes, name); });
}

Image8 readImage8(const std::filesystem::path& path) {
  return readImage8Memory(readFile(path), path.string());
}

}  // namespace limn
