// Reading picture files. OpenImageIO decodes in memory, but for WebP, which libwebp decodes; files are read
// whole.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "core/image/private/image_codec.h"
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

/// What decoders read from: a file of `bytes`. OpenImageIO's reader follows offsets before the first byte,
/// which an EXR's table of lines may hold.
class MemoryFile : public OIIO::Filesystem::IOMemReader {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : IOMemReader(bytes.data(), bytes.size()) {}
  bool seek(std::int64_t offset) override { return offset >= 0 && IOMemReader::seek(offset); }
  std::size_t pread(void* target, std::size_t size, std::int64_t offset) override {
    return offset < 0 ? 0 : IOMemReader::pread(target, size, offset);
  }
};

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

/// An opened decoder whose size has been checked against the limits; nothing of that size is allocated yet.
class Decoder {
 public:
  Decoder(std::span<const std::byte> bytes, const std::string& name)
      : name_(name), format_(detectImageFormat(bytes, name)), memory_(bytes) {
    const std::string problem = imageFileProblem(bytes, format_);
    if (!problem.empty()) fail(problem);
    input_ = OIIO::ImageInput::create(decoderName(format_), false);
    if (!input_) fail(OIIO::geterror());
    input_->set_ioproxy(&memory_);
    OIIO::ImageSpec wanted;
    wanted.attribute("oiio:UnassociatedAlpha", 1);
    if (!input_->open(name, spec_, wanted)) fail(input_->geterror());
    stored_ = spec_.roi();
    // Offsets of a PNG are those of a page that it is printed on.
    if (format_ == ImageFormat::exr) spec_.set_roi(spec_.roi_full());
    checkSize();
    // Elsewhere it is a note beside the picture, which glTF ignores; here it is the order of what is stored.
    if (format_ == ImageFormat::hdr) orientation_ = spec_.get_int_attribute("Orientation", 1);
    if (orientation_ > 4)
      fail("a size that begins with X (columns); one that begins with -Y or +Y is accepted");
  }

  /// Of the whole picture: an EXR may hold a part of it, or more than it.
  const OIIO::ImageSpec& spec() const { return spec_; }
  bool isSrgb() const { return format_ == ImageFormat::png || format_ == ImageFormat::jpeg; }
  ImageFormat format() const { return format_; }

  void read(const OIIO::TypeDesc& type, void* target) { readFirst(spec_.nchannels, type, target); }
  /// Leaves what the file does not hold as it is.
  void readFirst(int channels, const OIIO::TypeDesc& type, void* target) {
    const OIIO::ROI picture = spec_.roi();
    if (stored_ == picture) return readStored(channels, type, target);
    const std::size_t pixelBytes = static_cast<std::size_t>(channels) * type.size();
    std::vector<std::byte> stored(stored_.npixels() * pixelBytes);
    readStored(channels, type, stored.data());
    const OIIO::ROI shared = OIIO::roi_intersection(stored_, picture);
    if (shared.xbegin >= shared.xend) return;
    for (int y = shared.ybegin; y < shared.yend; ++y) {
      const auto startIn = [&](const OIIO::ROI& window) {
        const auto row = static_cast<std::size_t>(y - window.ybegin);
        return (row * static_cast<std::size_t>(window.width()) +
                static_cast<std::size_t>(shared.xbegin - window.xbegin)) *
               pixelBytes;
      };
      std::memcpy(static_cast<std::byte*>(target) + startIn(picture), stored.data() + startIn(stored_),
                  static_cast<std::size_t>(shared.width()) * pixelBytes);
    }
  }

 private:
  void readStored(int channels, const OIIO::TypeDesc& type, void* target) {
    if (!input_->read_image(0, 0, 0, channels, type, target)) fail(input_->geterror());
    turn(static_cast<std::byte*>(target), static_cast<std::size_t>(channels) * type.size());
  }

  /// Moves pixels from where the file has them to where they are seen, which OpenImageIO leaves to its
  /// caller.
  void turn(std::byte* pixels, std::size_t pixelBytes) const {
    const bool fromBelow = orientation_ == 3 || orientation_ == 4;
    const bool fromTheRight = orientation_ == 2 || orientation_ == 3;
    const auto width = static_cast<std::size_t>(stored_.width()),
               height = static_cast<std::size_t>(stored_.height());
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

  void checkSize() const {
    if (spec_.deep || spec_.depth > 1) fail("deep and volume pictures are not accepted");
    for (const OIIO::ROI& window : {stored_, spec_.roi()})
      limn::checkSize(window.width(), window.height(), spec_.nchannels, memory_.size(), name_);
  }

  std::string name_;
  ImageFormat format_;
  MemoryFile memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
  OIIO::ROI stored_;     // the pixels that the file holds
  int orientation_ = 1;  // of EXIF: the sides on which the first row and the first column are seen
};

std::vector<std::string> channelNames(const Decoder& decoder) {
  if (!decoder.isSrgb()) return decoder.spec().channelnames;
  switch (decoder.spec().nchannels) {
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
  Decoder decoder(bytes, name);
  const std::vector<std::string> names = channelNames(decoder);
  if (names.size() != static_cast<std::size_t>(decoder.spec().nchannels)) {
    throw Error(fmt::format("{}: {} channels without names", name, decoder.spec().nchannels));
  }
  Image image = [&] {
    try {
      return Image(decoder.spec().width, decoder.spec().height, names);
    } catch (const Error& failure) {
      throw Error(fmt::format("{}: {}", name, failure.what()));
    }
  }();
  decoder.read(OIIO::TypeDesc::FLOAT, image.data().data());
  if (decoder.isSrgb()) decodeSrgb(image);
  for (const OIIO::ParamValue& attribute : decoder.spec().extra_attribs) {
    const std::string key = attribute.name().string();
    if (key.starts_with(kMetadataPrefix) && attribute.type() == OIIO::TypeString) {
      image.metadata()[key.substr(std::strlen(kMetadataPrefix))] = attribute.get_string();
    }
  }
  return image;
}

Image8 decode8(std::span<const std::byte> bytes, const std::string& name) {
  if (isWebp(bytes)) return decodeWebp8(bytes, name).first;
  Decoder decoder(bytes, name);
  const std::size_t channels = static_cast<std::size_t>(decoder.spec().nchannels);
  if (!decoder.isSrgb() || channels > 4) {
    throw Error(fmt::format("{}: an 8-bit texture must be PNG, JPEG or WebP with 1 to 4 channels", name));
  }
  const std::size_t pixels =
      static_cast<std::size_t>(decoder.spec().width) * static_cast<std::size_t>(decoder.spec().height);
  std::vector<std::uint8_t> raw(pixels * channels);
  decoder.read(OIIO::TypeDesc::UINT8, raw.data());
  Image8 image{decoder.spec().width, decoder.spec().height, {}};
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
  Decoder decoder(bytes, name);
  if (decoder.format() != ImageFormat::png && decoder.format() != ImageFormat::exr)
    throw Error(fmt::format("{}: a PNG or an EXR is accepted", name));
  const OIIO::ImageSpec& spec = decoder.spec();
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  if (pixels > mostPixels)
    throw Error(
        fmt::format("{}: {}x{} pixels; at most {} are accepted", name, spec.width, spec.height, mostPixels));
  ImageChannel channel{spec.width, spec.height, static_cast<int>(8 * spec.format.size()), {}};
  channel.values.resize(static_cast<std::size_t>(pixels));
  decoder.readFirst(1, OIIO::TypeDesc::FLOAT, channel.values.data());
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
