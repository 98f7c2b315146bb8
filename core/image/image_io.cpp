// Reading and writing picture files. OpenImageIO decodes and encodes in memory, but for WebP, which libwebp
// decodes; files are read and written whole.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/image.h"
#include "core/image/private/exr_header.h"
#include "core/image/private/webp.h"
#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

constexpr const char* kMetadataPrefix = "limn/";

/// What any file may unfold to, and what for each of its bytes beyond that. Pictures of the world stay below
/// 30; deflate reaches 1032 where all is the same.
constexpr std::int64_t kUnfoldedBytes = std::int64_t{1} << 28, kUnfoldedRatio = 256;

enum class Format { exr, hdr, png, jpeg };

const char* decoderName(Format format) {
  switch (format) {
    case Format::exr:
      return "openexr";
    case Format::hdr:
      return "hdr";
    case Format::png:
      return "png";
    case Format::jpeg:
      return "jpeg";
  }
  return "";
}

/// By content, not by name: a wrong extension must not choose a decoder for foreign bytes.
Format detectFormat(std::span<const std::byte> bytes, const std::string& name) {
  const auto startsWith = [&](std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
  };
  if (startsWith("\x76\x2f\x31\x01")) return Format::exr;
  if (startsWith("\x89PNG\r\n\x1a\n")) return Format::png;
  if (startsWith("\xff\xd8\xff")) return Format::jpeg;
  if (startsWith("#?")) return Format::hdr;
  throw Error(fmt::format("{}: not a picture; EXR, HDR, PNG, JPEG or WebP is accepted", name));
}

/// Each scan of a progressive JPEG is a pass over the whole picture, however little it says; encoders make
/// ten or so.
constexpr int kMaxJpegScans = 100;

/// Empty, or what is wrong. libjpeg fills what a truncated file lacks with grey. A complete one has an end
/// marker (FF D9) after its first scan; within entropy-coded data FF is always followed by 00 or a restart
/// marker.
std::string jpegProblem(std::span<const std::byte> bytes) {
  const std::string truncated = "truncated JPEG";
  const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
  std::size_t i = 2;
  while (i + 4 <= bytes.size()) {  // header segments, whose thumbnails may contain end markers
    if (at(i) != 0xff) return truncated;
    const unsigned marker = at(i + 1);
    if (marker == 0xff) {
      ++i;
      continue;
    }
    i += 2 + (at(i + 2) << 8 | at(i + 3));
    if (marker == 0xda) break;
  }
  int scans = 1;
  for (; i + 1 < bytes.size(); ++i) {
    if (at(i) != 0xff) continue;
    if (at(i + 1) == 0xd9) return {};
    if (at(i + 1) == 0xda && ++scans > kMaxJpegScans)
      return fmt::format("more than {} scans, which is as many as are accepted", kMaxJpegScans);
  }
  return truncated;
}

/// Cyclic redundancy code of PNG chunks (ISO 3309; reflected polynomial EDB88320).
std::uint32_t chunkCode(std::span<const std::byte> bytes) {
  static constexpr auto kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      table[i] = i;
      for (int bit = 0; bit < 8; ++bit) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320u : 0u);
    }
    return table;
  }();
  std::uint32_t code = ~0u;
  for (const std::byte byte : bytes)
    code = code >> 8 ^ kTable[(code ^ std::to_integer<std::uint32_t>(byte)) & 255];
  return ~code;
}

/// Whether every chunk up to IEND is there and undamaged. libpng would print its complaints itself and
/// overlooks some; none of the checked files gives it a reason.
bool pngIsComplete(std::span<const std::byte> bytes) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
  };
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = number(at);
    if (length > bytes.size() - at - 12) return false;
    if (chunkCode(bytes.subspan(at + 4, length + 4)) != number(at + 8 + length)) return false;
    if (std::memcmp(bytes.data() + at + 4, "IEND", 4) == 0) return true;
    at += length + 12;
  }
  return false;
}

/// Empty, or what a decoder should not be given the file for.
std::string problemOf(std::span<const std::byte> bytes, Format format) {
  if (format == Format::jpeg) return jpegProblem(bytes);
  if (format == Format::exr) return exrHeaderProblem(bytes);
  return format == Format::png && !pngIsComplete(bytes) ? "truncated or damaged PNG" : "";
}

std::string reasonOf(std::string_view failure) {
  const std::string line = oneLine(failure);
  return line.empty() ? "unreadable or truncated" : line;
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
      : name_(name), format_(detectFormat(bytes, name)), memory_(bytes) {
    const std::string problem = problemOf(bytes, format_);
    if (!problem.empty()) fail(problem);
    input_ = OIIO::ImageInput::create(decoderName(format_), false);
    if (!input_) fail(OIIO::geterror());
    input_->set_ioproxy(&memory_);
    OIIO::ImageSpec wanted;
    wanted.attribute("oiio:UnassociatedAlpha", 1);
    if (!input_->open(name, spec_, wanted)) fail(input_->geterror());
    stored_ = spec_.roi();
    // Offsets of a PNG are those of a page that it is printed on.
    if (format_ == Format::exr) spec_.set_roi(spec_.roi_full());
    checkSize();
  }

  /// Of the whole picture: an EXR may hold a part of it, or more than it.

  const OIIO::ImageSpec& spec() const { return spec_; }
  bool isSrgb() const { return format_ == Format::png || format_ == Format::jpeg; }

  Format format() const { return format_; }

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
  Format format_;
  MemoryFile memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
  OIIO::ROI stored_;  // the pixels that the file holds
};

/// Runs a decoding step; whatever a decoder throws becomes an Error of one line that names the picture.
template <class Step>
auto guarded(const std::string& name, Step step) {
  try {
    return step();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("{}: not enough memory", name));
  } catch (const std::exception& failure) {
    throw Error(fmt::format("{}: {}", name, reasonOf(failure.what())));
  }
}

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
  if (decoder.format() != Format::png && decoder.format() != Format::exr)
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

/// Attributes of an EXR; text chunks (tEXt) of a PNG.
void addMetadata(OIIO::ImageSpec& spec, const Image& image) {
  for (const auto& [key, value] : image.metadata()) spec.attribute(kMetadataPrefix + key, value);
}

/// Encodes in memory: the encoder never sees the disk, so a full one is noticed when the file is written
/// whole.
std::vector<std::uint8_t> encode(const std::string& name, const char* encoder, const OIIO::ImageSpec& spec,
                                 const OIIO::TypeDesc& type, const void* pixels) {
  OIIO::Filesystem::IOVecOutput memory;
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(encoder);
  if (!output) throw Error(fmt::format("{}: {}", name, reasonOf(OIIO::geterror())));
  output->set_ioproxy(&memory);
  if (!output->open(name, spec) || !output->write_image(type, pixels) || !output->close()) {
    throw Error(fmt::format("{}: {}", name, reasonOf(output->geterror())));
  }
  return memory.buffer();
}

/// R, G, B as a display shows them.
std::vector<std::uint8_t> displayValues(const Image& image, const std::string& name, float exposureEv) {
  if (image.empty()) throw Error(fmt::format("{}: cannot write an empty image", name));
  const std::array<int, 3> rgb = image.rgbChannels(name);
  std::vector<std::uint8_t> pixels;
  pixels.reserve(image.pixelCount() * 3);
  const std::size_t channels = static_cast<std::size_t>(image.channelCount());
  for (std::size_t i = 0; i < image.pixelCount(); ++i) {
    for (const int c : rgb) {
      const float value = image.data()[i * channels + static_cast<std::size_t>(c)];
      pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * glsl::tone_map(value, exposureEv))));
    }
  }
  return pixels;
}

OIIO::ImageSpec displaySpec(const Image& image) {
  OIIO::ImageSpec spec(image.width(), image.height(), 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return spec;
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

void writeExr(const std::filesystem::path& path, const Image& image) {
  if (image.empty()) throw Error(fmt::format("{}: cannot write an empty image", path.string()));
  OIIO::ImageSpec spec(image.width(), image.height(), image.channelCount(), OIIO::TypeDesc::FLOAT);
  spec.channelnames = image.channels();
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // otherwise the encoder looks at the clock
  addMetadata(spec, image);
  const std::vector<std::uint8_t> file = guarded(path.string(), [&] {
    return encode(path.string(), "openexr", spec, OIIO::TypeDesc::FLOAT, image.data().data());
  });
  writeFile(path, std::as_bytes(std::span(file)));
}

std::vector<std::uint8_t> encodePng(const Image& image, const std::string& name, float exposureEv) {
  const std::vector<std::uint8_t> pixels = displayValues(image, name, exposureEv);
  OIIO::ImageSpec spec = displaySpec(image);
  addMetadata(spec, image);
  return guarded(name, [&] { return encode(name, "png", spec, OIIO::TypeDesc::UINT8, pixels.data()); });
}

std::vector<std::uint8_t> encodeWebp(const Image& image, const std::string& name) {
  const std::vector<std::uint8_t> pixels = displayValues(image, name, 0);
  OIIO::ImageSpec spec = displaySpec(image);
  spec.attribute("compression", "webp:90");
  return guarded(name, [&] { return encode(name, "webp", spec, OIIO::TypeDesc::UINT8, pixels.data()); });
}

void writePng(const std::filesystem::path& path, const Image& image, float exposureEv) {
  const std::vector<std::uint8_t> file = encodePng(image, path.string(), exposureEv);
  writeFile(path, std::as_bytes(std::span(file)));
}

void writeImage(const std::filesystem::path& path, const Image& image, float exposureEv) {
  const std::string extension = path.extension().string();
  if (extension == ".exr") return writeExr(path, image);
  if (extension == ".png") return writePng(path, image, exposureEv);
  throw UsageError(
      fmt::format("{}: unknown picture format '{}'; .exr or .png is accepted", path.string(), extension));
}

}  // namespace limn
