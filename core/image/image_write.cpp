// Writing picture files. OpenImageIO encodes in memory; files are written whole.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "core/image/private/image_codec.h"
#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

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
