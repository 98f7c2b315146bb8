// Measures what is gained by leaving out work that a scene does not need: each kind of such work is forced
// in, and pictures, times and memory are compared.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/ratio.h"
#include "core/image/image.h"
#include "core/render/renderer.h"

namespace limn::bench {

/// Holds one side of a comparison.
struct SavingSide {
  std::vector<double> ms;        ///< of each timed frame
  std::int64_t memoryBytes = 0;  ///< buffers and textures
  std::optional<double> rmse;    ///< against the reference, where there is one
  double squaresApart = 0;       ///< squared error summed over the pixels that are more than 1/255 apart
};

struct SavingResult {
  std::string name;                      ///< what is left out
  std::string how;                       ///< what tells that it is not needed
  bool exact = false;                    ///< the pictures must be equal to the bit; else at most 1/255 apart
  bool applies = false;                  ///< there is such work; the rest is void if not
  std::vector<std::string> passes = {};  ///< that are missing unless forced
  SavingSide forced = {}, without = {};
  Ratio ratio = {};              ///< frame time forced in / left out
  double largestDifference = 0;  ///< between the two pictures, in any channel; infinite where one has NaN
  double shareApart = 0;         ///< of the pixels that are more than 1/255 apart
  /// Returns whether the pictures agree as required. Where an early-out is more than 1/255 apart, it must be
  /// nearer to the reference: bounds detect an umbra in which an estimator may leave some light.
  LIMN_API bool holds() const;
};

struct SavingOptions {
  int frames = 9;  ///< timed, of each side, in three turns; 0: only pictures and memory are compared
  int warmup = 1;  ///< before each turn
  /// Called before each kind of work is measured, and before each turn: the part that is done, in [0, 1], and
  /// the name of the kind. May be empty.
  std::function<void(double fraction, const std::string& name)> progress = {};
};

/// Fills in how far the pictures of the two sides lie apart, and their errors there; `reference` may be null.
LIMN_API void comparePictures(SavingResult& result, const Image& forced, const Image& without,
                              const Image* reference);

/// Measures every kind of work that can be left out. `settings` says what is rendered; its `dynamic` and
/// `forced` are ignored. `reference` may be null: then no errors are reported. Throws what rendering throws.
LIMN_API std::vector<SavingResult> measureSavings(render::Renderer& renderer, const scene::CameraPose& camera,
                                                  const render::Settings& settings, const Image* reference,
                                                  const SavingOptions& options = {});

/// Returns a table with a line for each result.
LIMN_API std::string toMarkdown(std::span<const SavingResult> results);
/// Returns {"savings": [{"name", "how", "exact", "applies", "passes", "forced": {"frame_ms", "memory_bytes",
/// "rmse"}, "without": ..., "ratio": [value, low, high], "largest_difference" (null: infinite),
/// "share_apart", "holds"}]}.
LIMN_API std::string toJson(std::span<const SavingResult> results);

}  // namespace limn::bench
