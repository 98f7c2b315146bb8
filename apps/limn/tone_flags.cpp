#include "apps/limn/tone_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/limn/options.h"
#include "core/base/text.h"

namespace limn::app {
namespace {

/// Empty where the text is accepted.
std::string exposureProblem(const std::string& text) {
  if (text == kAutomaticExposure || exposureRange()(text).empty()) return {};
  return fmt::format("'{}' is not accepted; expected a number from {} to {}, or {}", text, -kMostExposureEv,
                     kMostExposureEv, kAutomaticExposure);
}

}  // namespace

CLI::Validator exposureRange() {
  return realRange(-kMostExposureEv, kMostExposureEv);
}

void addToneCurveFlag(CLI::App& command, ToneCurve& curve) {
  command
      .add_option_function<std::string>(
          "--tonemap", [&curve](const std::string& name) { curve = parseToneCurve(name); },
          "Tone curve of a .png output: none: clamped, the only one that keeps values comparable;\n"
          "neutral: Khronos PBR Neutral, which keeps base colours; agx: AgX, which keeps detail in what is\n"
          "very bright")
      ->type_name(fmt::format("{{{}}}", fmt::join(kToneCurves, ",")))
      ->default_str(kToneCurves[static_cast<size_t>(curve)]);
}

void ToneFlags::addTo(CLI::App& command) {
  addToneCurveFlag(command, curve);
  command
      .add_option(
          "--exposure", exposure,
          "Exposure of a .png output, EV; or auto: the geometric mean of the first picture's luminance\n"
          "becomes middle grey, 0.18 (pixels without light and 5 % at both ends do not count)")
      ->check(CLI::Validator(exposureProblem, fmt::format("[{:g} - {:g}] or {}", -kMostExposureEv,
                                                          kMostExposureEv, kAutomaticExposure)))
      ->capture_default_str();
}

ToneMapping ToneFlags::fixed() const {
  return {automatic() ? 0.f : static_cast<float>(parseNumber(exposure).value()), curve};
}

ToneMapping ToneFlags::toneMapping(const std::filesystem::path& file, const Image& picture) const {
  if (!automatic()) return fixed();
  const ToneMapping tone{automaticExposure(picture), curve};
  if (file.extension() == ".png") sayNote(fmt::format("exposure {:.3f} EV", tone.exposureEv));
  return tone;
}

}  // namespace limn::app
