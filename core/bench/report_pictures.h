// The pictures that go into the report page, and the windows of them that are shown magnified.
#pragma once

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

/// In pixels from the top left.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Window&) const = default;
};

/// Finds where the pictures of several techniques are wrong in the most different ways: the windows with the
/// largest sum, over their pixels, of the variance between pictures of the signed error in luminance. (One
/// picture: of its squared error.)
class LIMN_API WindowChooser {
 public:
  /// Display values; pictures of another size than the reference's are left out.
  explicit WindowChooser(const Image& reference);
  void add(const Image& picture);
  /// At most `count` windows that do not overlap, best first; none without pictures. Squares of a sixth of
  /// the shorter side, at least 16 and at most 64 pixels; smaller pictures have none.
  std::vector<Window> choose(int count) const;

 private:
  std::vector<double> variances() const;

  const Image& reference_;
  int pictures_ = 0;
  std::vector<double> sum_, squares_;  // of the errors
};

/// Pictures as data URIs, each file once. PNG files that together exceed `budget` bytes are halved in both
/// directions until they do not; their windows stay at full resolution.
class LIMN_API EmbeddedPictures {
 public:
  static constexpr std::uintmax_t kBudget = std::uintmax_t{32} << 20;

  /// `files`: the names in the rows, relative to `folder`. Only those inside it are read.
  EmbeddedPictures(const std::filesystem::path& folder, std::span<const std::string> files,
                   std::uintmax_t budget = kBudget);

  /// Position in uris(), -1 where there is no such picture.
  int whole(const std::string& file);
  int window(const std::string& file, const Window& window);
  /// The picture's pixels; empty where there is none.
  Image read(const std::string& file) const;

  const std::vector<std::string>& uris() const { return uris_; }
  int reduction() const { return reduction_; }  ///< 1, 2, 4, ...: pixels of the file per embedded pixel

 private:
  int add(const std::string& name, std::span<const std::uint8_t> png);

  std::filesystem::path folder_;
  int reduction_ = 1;
  std::vector<std::string> uris_;
  std::map<std::string, int> known_;
};

}  // namespace limn::bench
