// Declares one line of results.jsonl: what was asked, the error of the answer, and its cost.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/provenance.h"
#include "core/bench/suite.h"
#include "core/image/metrics.h"

namespace limn::bench {

struct FrameTime {
  double median = 0, q1 = 0, q3 = 0;  ///< milliseconds
  int n = 0;                          ///< timed frames; 0: not timed
  std::vector<double> samples;        ///< each of them; empty in rows of earlier versions
  int turns = 1;                      ///< in which they were taken, with other rows' in between
};

/// Holds the time of a frame's passes by purpose, milliseconds: medians of the passes, summed.
struct CostSplit {
  double maps = 0;       ///< drawing the scene into maps of shadows, light or surfaces
  double filters = 0;    ///< pyramids, summed-area tables and whatever else is derived from them
  double technique = 0;  ///< the technique's own passes
  double rest = 0;       ///< G-buffer, shading
};

/// Holds the time of a technique's own passes, and of the same with the technique's bound: milliseconds of
/// each frame in the order measured, in turns as those of FrameTime.
struct BoundTime {
  std::vector<double> own, bound;
  int turns = 1;
};

struct Cost {
  std::string renderer, backend;
  std::string timer = "off";  ///< "query" or "finish"; "off": untimed, as rows of the separation floor are
  bool software = false;      ///< rows of software and hardware renderers never share a table
  FrameTime frameMs;
  CostSplit split;                 ///< of a run of its own, with pass timing
  std::optional<BoundTime> bound;  ///< where the suite asks for it and the technique has one
  std::int64_t memoryBytes = 0;
  std::string driver;        ///< vendor and version, as OpenGL says; "" in rows of earlier versions
  std::string machine;       ///< machineName(); "" in rows of earlier versions
  int lights = 0;            ///< that the picture asks for; 0: not recorded
  int framesPerPicture = 1;  ///< that the error is of, with aa or a history; times are those of one
  std::vector<std::string> qualityParameters;  ///< "technique.parameter" that trade error for time
  /// Everything `limn render --stats` says, as JSON text; "" if there is nothing more.
  std::string details;
};

/// Counts pixels whose visibility is wrong in kind, not in degree: lit pixels in the umbra, and dark pixels
/// in full light. Both show as leaks and blotches however small the RMSE is.
struct Misjudged {
  static constexpr float kUmbra = 0.02f, kLit = 0.98f;  ///< reference below, above
  static constexpr float kTolerance = 0.1f;             ///< of the error
  std::size_t umbra = 0, litInUmbra = 0;                ///< pixels; the second: V > kTolerance
  std::size_t lit = 0, darkInLight = 0;                 ///< pixels; the second: V < 1 - kTolerance
};

struct Row {
  std::string key;  ///< rowKey of the case and cost.renderer
  Case what;
  std::string referenceFile;
  std::optional<double> referenceNoise;    ///< RMS relative to the mean
  std::optional<double> referenceSeconds;  ///< that it took on all cores; none in rows of earlier versions
  Metrics error;
  std::optional<Metrics> penumbra;     ///< visibility: over pixels whose reference lies in (0.02, 0.98)
  std::optional<Misjudged> misjudged;  ///< visibility
  std::vector<double> spectrum;        ///< errorSpectrum(); empty in rows of earlier versions
  Cost cost;
  Provenance provenance;   ///< empty in rows of earlier versions
  std::string picture;     ///< file in the folder of the results; "" if it was not kept
  std::string difference;  ///< the same for the difference image
  std::string
      failure;  ///< not empty: why there is no picture; error and cost are then void except for the renderer
  std::size_t line = 0;  ///< of the files it was read from, where later ones are newer; 0: from none
};

/// Returns one line of JSON, without the line's end.
LIMN_API std::string toJson(const Row& row);
/// Reads a row from a line of JSON. Throws Error that says what is wrong. Fields that rows of earlier
/// versions lack stay empty.
LIMN_API Row rowFromJson(const std::string& line);

/// Returns the file of the reference's picture beside the row's; "" if pictures were not kept.
LIMN_API std::string referencePicture(const Row& row);

}  // namespace limn::bench
