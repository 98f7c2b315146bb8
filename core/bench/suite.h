// Declares a bench suite: which questions are asked of which techniques, read from TOML. docs/bench.md lists
// every key with its type, range and default, and shows an example.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/export.h"
#include "core/question/scene_question.h"

namespace limn::bench {

/// Declares how good the references have to be.
struct ReferenceSettings {
  int spp = 256;       ///< samples per pixel; the maximum if noise is given
  double noise = 0.0;  ///< RMS relative to the mean; 0: take spp samples
  int bounces = 1;     ///< of indirect light, 1 unless given, of specular and final pictures 0 unless given
  int interfaces = 0;  ///< as Request::interfaces; of specular pictures 2 unless given
  bool operator==(const ReferenceSettings&) const = default;
};

/// Declares one picture of one technique: a row of the results.
struct Case : SceneQuestion {
  double fps = 0;         ///< of the scene's time in timed frames; 0: it stands still
  std::string technique;  ///< one name, or several joined by ","
  std::vector<std::pair<std::string, std::string>> parameters;  ///< "technique.parameter", value
  bool dynamic = true;
  int frames = 0, warmup = 0;  ///< of a turn
  int turns = 1;
  int timeWidth = 0, timeHeight = 0;  ///< size of the timed frames; 0: as the picture
  std::string title;                  ///< of the technique with its parameters, for people; may be empty
  bool baseline = false;              ///< what the other rows of a table are compared with
  bool picture = false;               ///< is kept
  bool bound = false;                 ///< the technique's bound is timed beside its own passes
  double maxMaskedShare = 0.005;      ///< see CompareOptions
  ReferenceSettings reference;
  bool operator==(const Case&) const = default;
};

/// Names the technique of the rows that show the error of unshadowed light times the reference's visibility.
inline constexpr const char* kSeparationFloor = "separation_floor";

/// Returns the question without the technique that answers it: cases with equal text share a reference.
LIMN_API std::string question(const Case& c);
/// Returns the whole case for people and filters:
/// scene/camera/light/term/256x256/dynamic/pcss?pcss.samples=16; where frames are timed at another size:
/// .../256x256 times at 1024x768/...
LIMN_API std::string label(const Case& c);
/// Returns 16 hexadecimal digits: the same for the same case on the same renderer.
LIMN_API std::string rowKey(const Case& c, std::string_view renderer);

struct Suite {
  std::string name;
  std::string about;           ///< what it shows, for lists; may be empty
  double minutes = 0;          ///< 0: not given
  double stallTimeout = 1800;  ///< seconds without progress after which a case is ended; 0: never
  std::vector<Case>
      cases;  ///< included ones first, each once; then in the order of the file, one question side by side
};

/// Parses a suite. Throws UsageError "FILE:LINE:COLUMN: ..." for syntax, unknown keys, wrong types and
/// values.
LIMN_API Suite parseSuite(std::string_view toml, const std::string& fileName);
/// Reads a suite from a file. Throws Error if the file cannot be read.
LIMN_API Suite readSuite(const std::filesystem::path& path);

/// Declares part `index` of `count`, from 1.
struct Shard {
  int index = 1, count = 1;
};
/// Parses "2/4". Throws UsageError for any other text.
LIMN_API Shard parseShard(std::string_view text);

/// Returns the part of `count`, from 1, that each of the cases is in. Questions are distributed round-robin,
/// so that each reference is rendered once; with fewer questions than parts, cases are distributed.
LIMN_API std::vector<int> partsOf(std::span<const Case> cases, int count);

/// Returns the cases whose label contains every filter, reduced to the shard's part of them (partsOf()).
LIMN_API std::vector<Case> selectCases(std::span<const Case> cases, std::span<const std::string> filters,
                                       Shard shard = {});

}  // namespace limn::bench
