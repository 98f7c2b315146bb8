// limn compare: how far an image is from its reference.
#include <fmt/format.h>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "apps/limn/provenance.h"
#include "apps/limn/tone_flags.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/compare_report.h"
#include "core/image/metrics.h"
#include "core/question/term.h"

namespace limn::app {
namespace {

struct CompareArguments {
  std::string image, reference, diff, maskTermRange;
  double exposure = 0;
  double maxMasked = 0.5;  // percent
  bool json = false;
};

std::optional<std::pair<float, float>> parseTermRange(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const size_t comma = text.find(',');
  const auto low =
      comma == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(0, comma));
  const auto high =
      comma == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(comma + 1));
  if (!low || !high || *low >= *high)
    throw UsageError(fmt::format("--mask-term-range '{}' is not accepted; expected a,b with a < b", text));
  return std::pair(static_cast<float>(*low), static_cast<float>(*high));
}

int runCompare(const CompareArguments& options) {
  CompareOptions compare;
  compare.exposureEv = static_cast<float>(options.exposure);
  compare.maxMaskedShare = options.maxMasked / 100;
  compare.maskTermRange = parseTermRange(options.maskTermRange);
  if (!options.diff.empty()) {
    checkExtension("--diff", options.diff, {".png"});
    checkWritable(options.diff);
    checkApart({options.diff}, {options.image, options.reference});
  }
  const Image image = readImage(options.image), reference = readImage(options.reference);
  const auto term = reference.metadata().find("term");
  compare.background = term != reference.metadata().end() && hasBackground(term->second);
  const Comparison comparison = compareImagesDetailed(image, reference, compare);
  if (!options.diff.empty()) {
    Image difference = differenceImage(comparison);
    sign(difference);
    writePng(options.diff, difference);
    sayWritten(options.diff);
  }
  const Metrics& metrics = comparison.metrics;
  fmt::print("{}\n", options.json ? metricsJson(metrics) : metricsTable(metrics));
  return 0;
}

}  // namespace

Action addCompareCommand(CLI::App& command) {
  auto options = std::make_shared<CompareArguments>();
  command.add_option("image", options->image, "EXR, HDR or PNG")->required();
  command.add_option("reference", options->reference, "Reference image: EXR, HDR or PNG")->required();
  command.add_flag("--json", options->json, "Print JSON");
  command.add_option("--diff", options->diff, "Write the FLIP map as a PNG in false colour");
  command.add_option(
      "--mask-term-range", options->maskTermRange,
      "Only pixels whose reference lies in the open interval (a,b), e.g. 0.02,0.98 for penumbrae");
  command.add_option("--exposure", options->exposure, "Exposure of the tone mapping for FLIP, EV")
      ->check(exposureRange());
  command
      .add_option("--max-masked", options->maxMasked,
                  "Fail above this share of pixels whose coverage, instance or depth differ, percent")
      ->capture_default_str()
      ->check(realRange(0.0, 100.0));
  command.footer(metricsHelp());
  return [options] { return runCompare(*options); };
}

}  // namespace limn::app
