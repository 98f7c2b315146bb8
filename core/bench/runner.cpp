#include "core/bench/runner.h"

#include "core/base/error.h"
#include "core/image/error_spectrum.h"

namespace limn::bench {
namespace {

/// Over penumbra pixels alone, since lit pixels hide the error of a visibility technique; nullopt where the
/// reference has none.
std::optional<Metrics> penumbraMetrics(const Image& image, const Reference& reference,
                                       CompareOptions options) {
  constexpr float kLow = Misjudged::kUmbra, kHigh = Misjudged::kLit;
  const int red = reference.image.rgbChannels()[0];
  bool any = false;
  for (std::size_t i = 0; i < reference.image.pixelCount() && !any; ++i) {
    const float value = reference.image.data()[i * static_cast<std::size_t>(reference.image.channelCount()) +
                                               static_cast<std::size_t>(red)];
    any = value > kLow && value < kHigh;
  }
  if (!any) return std::nullopt;
  options.maskTermRange = {kLow, kHigh};
  return compareImages(image, reference.image, options);
}

Misjudged misjudged(const Image& image, const Reference& reference, const std::vector<unsigned char>& mask) {
  Misjudged count;
  const int v = image.rgbChannels()[0], r = reference.image.rgbChannels()[0];
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const float truth = reference.image.data()[i * static_cast<std::size_t>(reference.image.channelCount()) +
                                               static_cast<std::size_t>(r)];
    const float value =
        image.data()[i * static_cast<std::size_t>(image.channelCount()) + static_cast<std::size_t>(v)];
    const bool umbra = truth<Misjudged::kUmbra, lit = truth> Misjudged::kLit;
    count.umbra += umbra;
    count.litInUmbra += umbra && value > Misjudged::kTolerance;
    count.lit += lit;
    count.darkInLight += lit && value < 1 - Misjudged::kTolerance;
  }
  return count;
}

Row measureRow(const Case& c, const std::string& key, const Reference& reference,
               const Callbacks& callbacks) {
  Row row;
  row.what = c;
  row.referenceFile = reference.file;
  row.referenceNoise = reference.noise;
  Measurement measurement = callbacks.measure(c);
  CompareOptions options;
  options.maxMaskedShare = c.maxMaskedShare;
  const Comparison comparison = compareImagesDetailed(measurement.image, reference.image, options);
  row.error = comparison.metrics;
  row.spectrum = errorSpectrum(measurement.image, reference.image, comparison.mask);
  if (c.term == "visibility") {
    row.penumbra = penumbraMetrics(measurement.image, reference, options);
    row.misjudged = misjudged(measurement.image, reference, comparison.mask);
  }
  if (c.picture && callbacks.keepPicture) {
    row.picture = callbacks.keepPicture(key, measurement.image);
    row.difference = callbacks.keepPicture(key + ".difference",
                                           differenceImage(measurement.image, reference.image, options));
  }
  row.cost = std::move(measurement.cost);
  return row;
}

}  // namespace

Summary runCases(std::span<const Case> cases, const std::string& renderer, ResultsFile& results,
                 const Callbacks& callbacks) {
  Summary summary;
  std::optional<Reference> reference;
  std::string referenceQuestion;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const auto report = [&](Progress::State state, std::string failure = "") {
      if (callbacks.progress) {
        callbacks.progress(
            {static_cast<int>(i), static_cast<int>(cases.size()), c, state, std::move(failure)});
      }
    };
    const std::string key = rowKey(c, renderer);
    if (results.contains(key)) {
      ++summary.skipped;
      report(Progress::State::skipped);
      continue;
    }
    report(Progress::State::started);
    Row row;
    try {
      if (!reference || referenceQuestion != question(c)) {
        reference.reset();
        reference = callbacks.reference(c);
        referenceQuestion = question(c);
      }
      row = measureRow(c, key, *reference, callbacks);
    } catch (const UsageError&) {
      throw;
    } catch (const Error& error) {
      row = Row{};
      row.what = c;
      row.failure = error.what();
    }
    row.key = key;
    row.cost.renderer = renderer;
    results.append(row);
    ++(row.failure.empty() ? summary.done : summary.failed);
    report(row.failure.empty() ? Progress::State::done : Progress::State::failed, row.failure);
  }
  return summary;
}

}  // namespace limn::bench
