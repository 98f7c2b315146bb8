// The library limn-image-files: picture files by OpenImageIO, in memory.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <stdexcept>

#include "core/image/private/image_files.h"

namespace limn::image_files {
namespace {

/// What decoders read from. OpenImageIO's reader follows offsets before the first byte, which an EXR's table
/// of lines may hold.
class MemoryFile : public OIIO::Filesystem::IOMemReader {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : IOMemReader(bytes.data(), bytes.size()) {}
  bool seek(std::int64_t offset) override { return offset >= 0 && IOMemReader::seek(offset); }
  std::size_t pread(void* target, std::size_t size, std::int64_t offset) override {
    return offset < 0 ? 0 : IOMemReader::pread(target, size, offset);
  }
};

Window windowOf(const OIIO::ROI& roi) {
  return {roi.xbegin, roi.ybegin, roi.width(), roi.height()};
}

OIIO::TypeDesc typeOf(Values values) {
  return values == Values::floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
}

class OpenedFile : public Decoder {
 public:
  OpenedFile(std::span<const std::byte> bytes, const char* format, const std::string& name)
      : memory_(bytes), input_(OIIO::ImageInput::create(format, false)) {
    if (!input_) throw std::runtime_error(OIIO::geterror());
    input_->set_ioproxy(&memory_);
    OIIO::ImageSpec spec, wanted;
    wanted.attribute("oiio:UnassociatedAlpha", 1);
    if (!input_->open(name, spec, wanted)) throw std::runtime_error(input_->geterror());
    header_ = {.stored = windowOf(spec.roi()),
               .whole = windowOf(spec.roi_full()),
               .channels = spec.nchannels,
               .valueBytes = static_cast<int>(spec.format.size()),
               .deep = spec.deep || spec.depth > 1,
               .orientation = spec.get_int_attribute("Orientation", 1),
               .names = spec.channelnames,
               .texts = {}};
    for (const OIIO::ParamValue& attribute : spec.extra_attribs)
      if (attribute.type() == OIIO::TypeString)
        header_.texts.emplace_back(attribute.name().string(), attribute.get_string());
  }

  const Header& header() const override { return header_; }

  void read(int channels, Values values, void* target) override {
    if (!input_->read_image(0, 0, 0, channels, typeOf(values), target))
      throw std::runtime_error(input_->geterror());
  }

 private:
  MemoryFile memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
  Header header_;
};

std::unique_ptr<Decoder> open(std::span<const std::byte> bytes, const char* format, const std::string& name) {
  return std::make_unique<OpenedFile>(bytes, format, name);
}

std::vector<std::uint8_t> encode(const Encoding& encoding, const void* pixels, const std::string& name) {
  OIIO::ImageSpec spec(encoding.width, encoding.height, static_cast<int>(encoding.names.size()),
                       typeOf(encoding.values));
  spec.channelnames = encoding.names;
  for (const auto& [key, value] : encoding.texts) spec.attribute(key, value);
  OIIO::Filesystem::IOVecOutput memory;
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(encoding.format);
  if (!output) throw std::runtime_error(OIIO::geterror());
  output->set_ioproxy(&memory);
  if (!output->open(name, spec) || !output->write_image(typeOf(encoding.values), pixels) || !output->close())
    throw std::runtime_error(output->geterror());
  return memory.buffer();
}

}  // namespace
}  // namespace limn::image_files

extern "C" __attribute__((visibility("default"))) const limn::image_files::Library* limnImageFiles() {
  using namespace limn::image_files;
  static constexpr Library offered{.version = LIMN_VERSION, .open = open, .encode = encode};
  return &offered;
}
