// Declares pictures in memory and on disk, with any number of named float channels of linear values.
//
// Channel names are those of EXR. limn writes: R, G, B (linear radiance, or the term asked for), A (the share
// of the pixel that shows a surface or a background), Z (distance from the camera plane, metres), coverage (1
// where its middle shows a surface), id (instance index, -1 where there is none; exact in float up to 2^24),
// albedo.R/G/B, N.X/Y/Z (world space shading normal).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Limits on what is read or created: pixels per side, pixels, and values (pixels times channels).
inline constexpr int kMaxImageSide = 32768;
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;
inline constexpr std::int64_t kMaxImageValues = std::int64_t{1} << 30;
inline constexpr int kMaxImageChannels = 256;
/// Limit on the values of a picture that is read from a file: 2 GiB.
inline constexpr std::int64_t kMaxReadValues = std::int64_t{1} << 29;

/// Holds width x height pixels, rows from the top, channel-interleaved float32.
class LIMN_API Image {
 public:
  Image() = default;
  /// Creates an image whose values are all 0. Throws Error if a size is not in [1, kMaxImageSide], the limits
  /// above are exceeded, or a channel name is empty or repeated.
  Image(int width, int height, std::vector<std::string> channels);
  /// Returns an image with channels R, G, B.
  static Image rgb(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  int channelCount() const { return static_cast<int>(channels_.size()); }
  std::size_t pixelCount() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  bool empty() const { return data_.empty(); }
  const std::vector<std::string>& channels() const { return channels_; }

  /// Returns the position of a channel within a pixel; nullopt if there is none of that name.
  std::optional<int> findChannel(std::string_view name) const;
  /// Returns the position of a channel within a pixel. Throws Error naming the existing channels if it is
  /// missing.
  int channel(std::string_view name) const;
  /// Returns the positions of R, G, B; for an image with a single channel (Y or any other) that position
  /// three times. Throws Error if there is neither; `name` says in the message which picture it is.
  std::array<int, 3> rgbChannels(std::string_view name = "image") const;

  std::span<float> data() { return data_; }
  std::span<const float> data() const { return data_; }
  /// Returns the channels of one pixel, x from the left, y from the top; not range-checked.
  std::span<float> pixel(int x, int y) { return {data_.data() + offset(x, y), channels_.size()}; }
  std::span<const float> pixel(int x, int y) const { return {data_.data() + offset(x, y), channels_.size()}; }
  float& at(int x, int y, int channel) { return data_[offset(x, y) + static_cast<std::size_t>(channel)]; }
  float at(int x, int y, int channel) const {
    return data_[offset(x, y) + static_cast<std::size_t>(channel)];
  }

  /// Adds a channel at the end. `values` holds one value per pixel, or is empty for zeros. Throws Error on a
  /// repeated name or a wrong count. Moves all data: where speed matters, create the image with all its
  /// channels.
  void addChannel(std::string name, std::span<const float> values = {});
  /// Returns an image with copies of the named channels, in that order.
  Image select(std::span<const std::string> names) const;
  Image select(std::initializer_list<std::string> names) const;

  /// Returns free-form text that is stored with an EXR (as attributes "limn/KEY") or a PNG (as tEXt chunks
  /// with the keyword "limn/KEY") and read back; for example "noise_rms".
  std::map<std::string, std::string>& metadata() { return metadata_; }
  const std::map<std::string, std::string>& metadata() const { return metadata_; }

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)) *
           channels_.size();
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<std::string> channels_;
  std::vector<float> data_;
  std::map<std::string, std::string> metadata_;
};

/// Holds an 8-bit RGBA picture as stored (textures): rows from the top, no colour conversion, missing alpha
/// 255.
struct Image8 {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> data;  ///< width * height * 4
};

/// Loads the library that decodes and encodes picture files, as the first picture would. Throws Error in one
/// line when it is missing or another limn's. It is called before long work whose picture would be lost
/// otherwise, and after all refusals that are quicker: it takes half a second.
LIMN_API void loadPictureLibrary();

/// Returns the image in an EXR (first part, all channels), HDR, PNG, JPEG or still WebP file. The result is
/// linear: 8- and 16-bit colours are decoded from sRGB (alpha is not), float formats are not converted;
/// one- and three-channel files get channels Y and R, G, B. An EXR is as large as its display window: what
/// its pixels leave of that is 0, those beyond it are left out. An HDR may be stored from any corner, row by
/// row. Throws Error with one line naming the file if it is missing, truncated, not an image, or larger than
/// the limits (checked before anything is allocated): at most kMaxReadValues values; above 256 MiB of them
/// also at most 256 bytes for each byte of the file, so that a small file cannot fill the memory.
LIMN_API Image readImage(const std::filesystem::path& path);

/// Does the same from memory. `name` is used in messages; the content alone chooses the decoder.
LIMN_API Image readImageMemory(std::span<const std::byte> bytes, const std::string& name);

/// Holds the first channel of a picture whose values are no colours (heights): rows from the top.
struct ImageChannel {
  int width = 0;
  int height = 0;
  int bits = 0;               ///< of a value in the file
  std::vector<float> values;  ///< width * height
};

/// Returns the first channel of a PNG (values from 0 to 1, not decoded from sRGB) or of an EXR (as it is).
/// Throws Error with one line that begins with `name` for anything else and for more than `mostPixels`
/// pixels, beside the limits of readImageMemory(); sizes are checked before anything is allocated.
LIMN_API ImageChannel readFirstChannelMemory(std::span<const std::byte> bytes, const std::string& name,
                                             std::uint64_t mostPixels);

/// Returns a texture as 8-bit RGBA (PNG, JPEG, still WebP; 16-bit values are rounded), from memory or a file.
LIMN_API Image8 readImage8Memory(std::span<const std::byte> bytes, const std::string& name);
LIMN_API Image8 readImage8(const std::filesystem::path& path);

/// Writes every channel as float32, ZIP-compressed, with the metadata. The bytes depend on the image alone:
/// the file's date (capDate) is always the first second of 1970. The file is written completely or not at
/// all; throws Error naming it in the latter case (missing folder, full disk, no permission).
LIMN_API void writeExr(const std::filesystem::path& path, const Image& image);

/// Returns a PNG in memory: R, G, B as 8-bit sRGB of clamp(2^exposureEv * value, 0, 1), with NaN as 0, and
/// the metadata. `name` is used in messages.
LIMN_API std::vector<std::uint8_t> encodePng(const Image& image, const std::string& name,
                                             float exposureEv = 0.0f);
/// Returns a lossy WebP in memory: the 8-bit values of the PNG at quality 90, without metadata. It takes
/// about a fifth of the PNG's size.
LIMN_API std::vector<std::uint8_t> encodeWebp(const Image& image, const std::string& name);
/// Writes what encodePng() returns to a file, completely or not at all.
LIMN_API void writePng(const std::filesystem::path& path, const Image& image, float exposureEv = 0.0f);

/// Writes by extension: .exr as writeExr(), .png as writePng(). Throws UsageError for any other.
LIMN_API void writeImage(const std::filesystem::path& path, const Image& image, float exposureEv = 0.0f);

}  // namespace limn
