// Prepares the pictures of the report page, and the windows of them that are shown magnified.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/image/image.h"

namespace limn::bench {

/// Declares a part of a picture, in pixels from the top left.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Window&) const = default;
};

/// Finds where the pictures of several techniques are wrong in the most different ways: the windows with the
/// largest sum, over their pixels, of the variance between pictures of the signed error in luminance (with
/// one picture: of its squared error).
class LIMN_API WindowChooser {
 public:
  /// Takes the reference in display values. Pictures of another size than the reference are left out.
  explicit WindowChooser(const Image& reference);
  void add(const Image& picture);
  /// Returns at most `count` windows that do not overlap, best first; none without pictures. Windows are
  /// squares of a sixth of the shorter side, at least 16 and at most 64 pixels; smaller pictures have none.
  std::vector<Window> choose(int count) const;

 private:
  std::vector<double> variances() const;

  const Image& reference_;
  int pictures_ = 0;
  std::vector<double> sum_, squares_;  // of the errors
};

/// Holds pictures as data URIs, each file once. Whole pictures are PNG where their files together have at
/// most `budget` bytes, and lossy WebP, a fifth of that, where they do not; beyond that they are halved in
/// both directions until they fit. Windows are always PNG at full resolution, thumbnails lossy WebP.
class LIMN_API EmbeddedPictures {
 public:
  static constexpr std::uintmax_t kBudget = std::uintmax_t{8} << 20;
  static constexpr int kThumbnail = 192;  ///< the longest side of a thumbnail; page.css draws it as wide

  /// Takes `files`, the names in the rows, relative to `folder`. Only files inside that folder are read.
  EmbeddedPictures(const std::filesystem::path& folder, std::span<const std::string> files,
                   std::uintmax_t budget = kBudget);

  /// Returns the picture's position in uris(), -1 where there is no such picture.
  int whole(const std::string& file);
  int thumbnail(const std::string& file);
  int window(const std::string& file, const Window& window);
  /// Returns the picture's pixels; empty where there is no such picture.
  Image read(const std::string& file) const;

  const std::vector<std::string>& uris() const { return uris_; }
  /// Returns an element for each picture, "picture-" and its position, in the order in which the page should
  /// read them: thumbnails, windows, whole pictures.
  std::string elements() const;
  bool compressed() const { return compressed_; }  ///< whether whole pictures are WebP
  int reduction() const { return reduction_; }     ///< 1, 2, 4, ...: pixels of the file per embedded pixel

 private:
  enum class Kind { thumbnail, window, whole };
  const Image& decoded(const std::string& file);
  int add(const std::string& name, Kind kind, const char* type, std::span<const std::uint8_t> file);

  std::filesystem::path folder_;
  bool compressed_ = false;
  int reduction_ = 1;
  std::vector<std::string> uris_;
  std::array<std::vector<std::size_t>, 3> positions_;  // by Kind
  std::map<std::string, int> known_;
  std::string decodedFile_;  ///< of the picture that was decoded last: what is asked of it follows
  Image decoded_;
};

}  // namespace limn::bench
