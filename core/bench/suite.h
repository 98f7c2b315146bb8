// A bench suite: which questions are asked of which techniques. Read from TOML:
//
//     name = "quick"
//     minutes = 2                 # what the whole suite takes on 2 cores without a GPU; said first
//     stall_timeout = 1800        # seconds: a case that shows no sign of life for so long, neither a frame nor a
//                                 # pass of a reference, is ended and fails; 0: never
//     include = ["ch5.toml"]      # the cases of other suites, files beside this one; then scenes and
//                                 # techniques may be missing
//     sizes = ["256x256"]         # of the pictures whose error is measured
//     time_size = "1024x768"      # of the timed frames; default: as the pictures
//     frames = 20                 # timed frames of a turn
//     warmup = 3                  # frames before them
//     turns = 1                   # how often all rows are timed, one after the other: a machine's drift then
//                                 # shows in the intervals of ratios instead of in the ratios
//     modes = ["dynamic"]         # and/or "static"
//     term = "visibility"
//     reference = {spp = 256}     # or {noise = 0.005}: RMS relative to the mean; also bounces, for
//                                 # the terms indirect, specular and final, and interfaces (a number
//                                 # or "all"), for the latter two; "all" for caustic and media, too
//
//     pictures = true             # keep every picture as PNG, and the reference's
//
//     [[scenes]]
//     scene = "cornell_box"       # asset name or file
//     time = 1.5                  # seconds of its animation
//     fps = 30                    # timed frames play it from there on; default: it stands still
//     cameras = ["front"]         # default: the first one
//     lights = ["ceiling"]        # default: all lights together ("")
//     light_sizes = [0.3, 1.2]    # as --light-size; default: as the scene has them
//     environment = "sky.exr"     # equirectangular map
//     environment_lights = [0, 0.015]   # thresholds, as --environment-lights; 0: the map unshadowed
//     environment_resolution = 48       # and the other --environment options
//     environment_shape = "squares"
//     environment_reflection = "area"
//     sigma_a = 0.02              # of the medium, per metre, as --sigma-a; default: the scene's
//     sigma_s = "0.1,0.1,0.2"     # likewise; one number or a text of three
//     g = [-0.7, 0, 0.7]          # as --g
//     set_light = ["key.size=0.5"]      # as --set-light, for all cases of the scene
//     eye = "0,1,3"               # as the options --eye, --target, --fov, --animation, --default-lights,
//     target = "0,0.5,0"          # --environment-rotation, --environment-scale and --grid; so are
//     fov = 40                    # animation, default_lights, environment_rotation, environment_scale and
//                                 # grid
//
//     [[techniques]]
//     technique = "pcss"          # or a combination, "vssm,airlight"
//     parameters = {samples = [16, 64]}   # lists are swept, all combinations
//     label = "PCSS"              # for people; default: the technique and its parameters
//     baseline = true             # the first such row: tables compare the others with it
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/export.h"

namespace limn::bench {

/// How good the references have to be.
struct ReferenceSettings {
  int spp = 256;       ///< samples per pixel; the maximum if noise is given
  double noise = 0.0;  ///< RMS relative to the mean; 0: take spp samples
  int bounces = 1;     ///< of indirect light, 1 unless given, of specular and final pictures 0 unless given
  int interfaces = 0;  ///< as Request::interfaces; of specular pictures 2 unless given
  bool operator==(const ReferenceSettings&) const = default;
};

/// As the options --environment and --environment-...
struct EnvironmentSettings {
  std::string map;    ///< file; "": none but the scene's
  double lights = 0;  ///< threshold; 0: not decomposed
  int resolution = 48;
  std::string shape = "squares", reflection = "area";
  bool operator==(const EnvironmentSettings&) const = default;
};

/// As the options --sigma-a, --sigma-s and --g; nothing: as the scene has them.
struct MediumSettings {
  std::string sigmaA, sigmaS;  ///< one number, or three with commas
  std::optional<double> g;
  bool operator==(const MediumSettings&) const = default;
};

/// As the options of these names; as they are: nothing is changed.
struct SceneChanges {
  std::string eye, target;
  double fov = 0;  ///< degrees
  std::string animation;
  std::vector<std::string> setLight;
  std::string defaultLights = "auto";
  double environmentRotation = 0, environmentScale = 1;  ///< degrees; factor
  std::string grid;
  bool operator==(const SceneChanges&) const = default;
};
/// For people, in one line; empty where nothing is changed.
LIMN_API std::string describe(const SceneChanges& changes);
/// The same of a medium.
LIMN_API std::string describe(const MediumSettings& medium);

/// One picture of one technique: a row of the results.
struct Case {
  std::string scene;
  std::string camera;  ///< "": the scene's first
  std::string light;   ///< "": all
  EnvironmentSettings environment;
  MediumSettings medium;
  SceneChanges changes;
  double lightSize = 0;  ///< as --light-size; 0: as the scene has them
  double time = 0;       ///< seconds of the scene's animation
  double fps = 0;        ///< of that time in timed frames; 0: it stands still
  std::string term;      ///< as --output-term
  int width = 0, height = 0;
  std::string technique;                                        ///< one name, or several joined by ","
  std::vector<std::pair<std::string, std::string>> parameters;  ///< "technique.parameter", value
  bool dynamic = true;
  int frames = 0, warmup = 0;  ///< of a turn
  int turns = 1;
  int timeWidth = 0, timeHeight = 0;  ///< size of the timed frames; 0: as the picture
  std::string title;                  ///< of the technique with its parameters, for people; may be empty
  bool baseline = false;              ///< what the other rows of a table are compared with
  bool picture = false;               ///< keep it
  double maxMaskedShare = 0.005;      ///< see CompareOptions
  ReferenceSettings reference;
  bool operator==(const Case&) const = default;
};

/// The technique name of the rows that show the error of unshadowed light times the reference's visibility.
inline constexpr const char* kSeparationFloor = "separation_floor";

/// The question without who answers it: cases with equal text share a reference.
LIMN_API std::string question(const Case& c);
/// The whole case for people and filters: scene/camera/light/term/256x256/dynamic/pcss?pcss.samples=16; where
/// frames are timed at another size: .../256x256 times at 1024x768/...
LIMN_API std::string label(const Case& c);
/// 16 hexadecimal digits: the same for the same case on the same renderer.
LIMN_API std::string rowKey(const Case& c, std::string_view renderer);

struct Suite {
  std::string name;
  double minutes = 0;          ///< 0: not said
  double stallTimeout = 1800;  ///< seconds without progress after which a case is ended; 0: never
  std::vector<Case>
      cases;  ///< included ones first, each once; then in the order of the file, one question side by side
};

/// Throws UsageError "FILE:LINE:COLUMN: ..." for syntax, unknown keys, wrong types and values.
LIMN_API Suite parseSuite(std::string_view toml, const std::string& fileName);
/// Reads a file; Error if it cannot be read.
LIMN_API Suite readSuite(const std::filesystem::path& path);

/// Part `index` of `count`, from 1.
struct Shard {
  int index = 1, count = 1;
};
/// "2/4"; throws UsageError.
LIMN_API Shard parseShard(std::string_view text);

/// The cases whose label contains every filter, then the shard's part of them. Questions are dealt out
/// round-robin, so that each reference is rendered once; with fewer questions than shards, cases are.
LIMN_API std::vector<Case> selectCases(std::span<const Case> cases, std::span<const std::string> filters,
                                       Shard shard = {});

}  // namespace limn::bench
