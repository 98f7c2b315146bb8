// Declares the options that say how a .png shows linear values.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "core/image/tone_mapping.h"

namespace limn::app {

/// Holds the value of --exposure that leaves it to the picture.
inline constexpr const char* kAutomaticExposure = "auto";

/// Holds the largest exposure that is accepted, EV, in either direction.
inline constexpr float kMostExposureEv = 60;

/// Accepts an exposure, EV, as a number alone.
CLI::Validator exposureRange();

/// Gives the command --tonemap.
void addToneCurveFlag(CLI::App& command, ToneCurve& curve);

/// Holds --tonemap and --exposure, of which the exposure may depend on the picture.
struct ToneFlags {
  ToneCurve curve = ToneCurve::none;
  std::string exposure = "0";  ///< EV, or "auto"

  void addTo(CLI::App& command);
  bool automatic() const { return exposure == kAutomaticExposure; }
  /// Returns the exposure and the curve; EV 0 where the exposure is automatic.
  ToneMapping fixed() const;
  /// Returns what a file of that name is written with. Says the automatic exposure of a .png on stderr.
  ToneMapping toneMapping(const std::filesystem::path& file, const Image& picture) const;
};

}  // namespace limn::app
