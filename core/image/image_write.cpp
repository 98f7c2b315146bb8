// Writing picture files. The library of core/image/files encodes in memory; files are written whole.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "core/image/private/image_codec.h"
#include "core/image/private/image_files.h"
#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

using image_files::Encoding;
using image_files::Values;

/// Attributes of an EXR; text chunks (tEXt) of a PNG.
void addMetadata(Encoding& encoding, const Image& image) {
  for (const auto& [key, value] : image.metadata()) encoding.texts.emplace_back(kMetadataPrefix + key, value);
}

std::vector<std::uint8_t> encode(const std::string& name, const Encoding& encoding, const void* pixels) {
  return guarded(name, [&] { return image_files::library().encode(encoding, pixels, name); });
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

Encoding displayEncoding(const char* format, const Image& image) {
  return {.format = format,
          .width = image.width(),
          .height = image.height(),
          .names = {"R", "G", "B"},
          .values = Values::bytes,
          .texts = {{"oiio:ColorSpace", "sRGB"}}};
}

}  // namespace

void writeExr(const std::filesystem::path& path, const Image& image) {
  if (image.empty()) throw Error(fmt::format("{}: cannot write an empty image", path.string()));
  Encoding encoding{.format = "openexr",
                    .width = image.width(),
                    .height = image.height(),
                    .names = image.channels(),
                    .values = Values::floats,
                    .texts = {{"compression", "zip"},
                              // Otherwise the encoder looks at the clock.
                              {"DateTime", "1970:01:01 00:00:00"}}};
  addMetadata(encoding, image);
  const std::vector<std::uint8_t> file = encode(path.string(), encoding, image.data().data());
  writeFile(path, std::as_bytes(std::span(file)));
}

std::vector<std::uint8_t> encodePng(const Image& image, const std::string& name, float exposureEv) {
  const std::vector<std::uint8_t> pixels = displayValues(image, name, exposureEv);
  Encoding encoding = displayEncoding("png", image);
  addMetadata(encoding, image);
  return encode(name, encoding, pixels.data());
}

std::vector<std::uint8_t> encodeWebp(const Image& image, const std::string& name) {
  const std::vector<std::uint8_t> pixels = displayValues(image, name, 0);
  Encoding encoding = displayEncoding("webp", image);
  encoding.texts.emplace_back("compression", "webp:90");
  return encode(name, encoding, pixels.data());
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
