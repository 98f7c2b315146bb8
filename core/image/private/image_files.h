// Declares the library limn-image-files, which decodes and encodes picture files by OpenImageIO. It is apart
// because the 250 libraries that OpenImageIO needs on Debian take half a second to load: liblimn loads it
// with the first picture that it reads or writes, or when loadPictureLibrary() is called. It needs nothing of
// liblimn, and both have this header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace limn::image_files {

/// Numbers of a pixel, as they are handed over: 8-bit values as they are stored, or floats.
enum class Values { bytes, floats };

/// A rectangle of pixels.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Window&) const = default;
};

/// Holds what an opened file says of its picture; nothing of it is checked.
struct Header {
  Window stored, whole;  ///< the pixels that the file holds, and those of the picture
  int channels = 0;
  int valueBytes = 0;   ///< of a stored number
  bool deep = false;    ///< several values for a pixel, or a volume
  int orientation = 1;  ///< of EXIF: the sides on which the first row and the first column are seen
  std::vector<std::string> names;                          ///< of channels
  std::vector<std::pair<std::string, std::string>> texts;  ///< attributes that are text
};

/// An opened file. Its bytes must outlive it.
class Decoder {
 public:
  virtual ~Decoder() = default;
  virtual const Header& header() const = 0;
  /// Writes the first `channels` of the stored pixels to `target`, rows as the file has them. Throws
  /// std::runtime_error with what the library says.
  virtual void read(int channels, Values values, void* target) = 0;
};

/// Holds what is to be written beside the pixels.
struct Encoding {
  const char* format = "";  ///< as Library::open takes it, or "webp"
  int width = 0, height = 0;
  std::vector<std::string> names;  ///< of channels
  Values values = Values::bytes;
  std::vector<std::pair<std::string, std::string>> texts;  ///< attributes, the encoder's own as well
};

/// What the library offers.
struct Library {
  const char* version;  ///< limn's, which must be that of liblimn
  /// Opens a file in memory by the decoder "openexr", "hdr", "png" or "jpeg"; `name` is for messages. Throws
  /// std::runtime_error with what the library says.
  std::unique_ptr<Decoder> (*open)(std::span<const std::byte> bytes, const char* format,
                                   const std::string& name);
  /// Returns a file. It never sees the disk, so that a full one is noticed when the file is written whole.
  /// Throws std::runtime_error with what the library says.
  std::vector<std::uint8_t> (*encode)(const Encoding& encoding, const void* pixels, const std::string& name);
};

/// Returns the library, which the first call loads from the folder limn/ beside liblimn. Throws Error if it
/// is not there or another version's. Threads may call it at once.
const Library& library();

}  // namespace limn::image_files

/// The library's only symbol.
extern "C" const limn::image_files::Library* limnImageFiles();
