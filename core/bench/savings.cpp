#include "core/bench/savings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/bench/private/columns.h"
#include "core/bench/private/comparison.h"
#include "core/bench/private/markdown.h"
#include "core/image/metric_table.h"
#include "core/image/metrics.h"
#include "core/question/term.h"
#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

using render::Saving;
using render::Settings;

constexpr int kTurns = 3;                 // the two sides take turns, so that a machine's drift meets both
constexpr double kApart = 1.0 / 255;      // what per-pixel early-outs may change
constexpr double kErrorTolerance = 1e-4;  // of the RMSE, relative: rounding

struct Comparison {
  SavingResult result;
  Settings forced, without;
};

/// What the renderer's last frame did and what it left out.
struct Frame {
  std::set<std::string> run, leftOut;
};
Frame lastFrame(const render::Renderer& renderer) {
  Frame frame;
  for (const frame::PassReport& pass : renderer.explain()) {
    if (pass.state == frame::PassState::run)
      frame.run.insert(fmt::format("{}: {}", pass.technique, pass.name));
    if (pass.state == frame::PassState::leftOut)
      frame.leftOut.insert(fmt::format("{}: {}", pass.technique, pass.name));
  }
  return frame;
}

std::vector<Comparison> comparisons(const Settings& asked) {
  Settings plain = asked;
  plain.dynamic = true;
  plain.forced.clear();
  plain.channels = true;
  std::vector<Comparison> all;
  const auto force = [&](Saving saving, const char* name, const char* how) {
    Settings forced = plain;
    forced.forced = {saving};
    all.push_back({{.name = name, .how = how, .exact = true}, forced, plain});
  };
  force(Saving::darkLights, "dark lights", "a light emits nothing");
  force(Saving::environment, "environment light", "the scene has no environment, or a black one");
  force(Saving::culling, "culled instances", "their bounds lie outside what a view sees");

  Settings kept = plain;
  kept.dynamic = false;
  all.push_back({{.name = "unchanged results",
                  .how = "nothing they depend on moved since the last frame",
                  .exact = true},
                 plain,
                 kept});

  for (size_t i = 0; i < plain.techniques.size(); ++i) {
    const render::TechniqueUse& use = plain.techniques[i];
    for (const Parameter& parameter : use.parameters.declared()) {
      if (!parameter.forcing) continue;
      Settings forced = plain;
      forced.techniques[i].parameters.set(parameter.name, parameter.forcing);
      all.push_back(
          {{.name = fmt::format("{}.{}", use.plugin->info->name, parameter.name), .how = parameter.doc},
           forced,
           plain});
    }
  }
  return all;
}

/// Configures and renders one frame.
void show(render::Renderer& renderer, const scene::CameraPose& camera, const Settings& settings) {
  renderer.configure(settings);
  renderer.setCamera(camera);
  renderer.render();
}

/// A second frame, in which a static renderer keeps what it has.
Image secondFrame(render::Renderer& renderer) {
  renderer.render();
  return renderer.read();
}

/// What differs between the sides; nothing is timed yet.
void look(Comparison& c, render::Renderer& renderer, const scene::CameraPose& camera,
          const Image* reference) {
  CompareOptions anyMask;
  anyMask.maxMaskedShare = 1;
  anyMask.background = termInfo(c.forced.term).background;
  const auto side = [&](const Settings& settings, SavingSide& result, Frame& frame) {
    show(renderer, camera, settings);
    // What the forced frame alone used is kept for one graph, and freed when the next one is built.
    if (&result == &c.result.without) show(renderer, camera, settings);
    Image image = secondFrame(renderer);
    frame = lastFrame(renderer);
    result.memoryBytes = renderer.memoryBytes();
    if (reference) result.rmse = compareImages(image, *reference, anyMask).rmse;
    return image;
  };
  Frame full, less;
  const Image forced = side(c.forced, c.result.forced, full);
  const Image without = side(c.without, c.result.without, less);
  std::ranges::set_difference(full.run, less.run, std::back_inserter(c.result.passes));
  std::set<std::string> left;  // also what is work within a pass that runs anyway, as one light of several
  std::ranges::set_difference(less.leftOut, full.leftOut, std::inserter(left, left.end()));
  for (const std::string& name : left)
    if (!full.run.contains(name)) c.result.passes.push_back(name);
  comparePictures(c.result, forced, without, reference);
}

/// `tell` is called with the turn before each.
void time(Comparison& c, render::Renderer& renderer, const scene::CameraPose& camera,
          const SavingOptions& options, const std::function<void(int turn)>& tell) {
  for (int turn = 0; turn < kTurns; ++turn) {
    tell(turn);
    for (const auto& [settings, side] :
         {std::pair(&c.forced, &c.result.forced), {&c.without, &c.result.without}}) {
      Settings timed = *settings;
      timed.channels = false;
      show(renderer, camera, timed);
      const int frames = (options.frames + kTurns - 1) / kTurns;
      const auto samples = render::timeFrames(renderer, frames, options.warmup);
      side->ms.insert(side->ms.end(), samples.begin(), samples.end());
    }
  }
  c.result.ratio = ratioOfMedians({c.result.forced.ms, kTurns}, {c.result.without.ms, kTurns});
}

/// Whether anything is left out at all. Culling shows in no pass: there is something to it where a view's
/// volume ends inside the scene, which drawing everything would show as time only, so it is always measured.
bool applies(const SavingResult& result, const Settings& forced) {
  const bool culling = forced.forced == std::vector{Saving::culling};
  return culling || !result.exact || !result.passes.empty();
}

std::string pictureText(const SavingResult& r) {
  constexpr const MetricInfo& rmse = metricInfo(&Metrics::rmse);
  std::string text =
      r.largestDifference == 0 ? "equal" : fmt::format("{:.2g} apart at most", r.largestDifference);
  if (r.shareApart > 0) text += fmt::format(", {:.3f} % by more than 1/255", 100 * r.shareApart);
  if (r.shareApart > 0 && r.forced.rmse)
    text += fmt::format(" (squared error there {:.2g} times that when forced)",
                        r.without.squaresApart / std::max(r.forced.squaresApart, 1e-30));
  if (r.forced.rmse && r.largestDifference > 0)
    text += fmt::format("; {} {} forced, {} without", rmse.label, shownText(rmse, *r.forced.rmse),
                        shownText(rmse, *r.without.rmse));
  return r.holds() ? text : text + " (NOT as it must be)";
}

/// A column with a line for each kind of work; kinds that do not apply have none of its cells.
template <class Function>
MarkdownColumn<SavingResult> applied(std::string head, Function cell) {
  return {{std::move(head)}, [cell](const SavingResult& r) { return r.applies ? cell(r) : std::string(); }};
}

MarkdownColumn<SavingResult> timeColumn(const char* of, SavingSide SavingResult::*side) {
  return applied(fmt::format("{} {}", kFrameTime.head, of), [side](const SavingResult& r) {
    return shownText(kFrameTime, render::quartiles((r.*side).ms).median);
  });
}

MarkdownColumn<SavingResult> memoryColumn(const char* of, SavingSide SavingResult::*side) {
  return applied(fmt::format("{} {}", kMemory.head, of), [side](const SavingResult& r) {
    return shownText(kMemory, static_cast<double>((r.*side).memoryBytes));
  });
}

std::vector<MarkdownColumn<SavingResult>> savingColumns() {
  return {
      {{"left out", Align::left}, [](const SavingResult& r) { return r.name; }},
      {{"because", Align::left}, [](const SavingResult& r) { return r.how; }},
      applied("passes", [](const SavingResult& r) { return fmt::format("{}", r.passes.size()); }),
      timeColumn("forced", &SavingResult::forced),
      timeColumn("without", &SavingResult::without),
      applied("ratio (95 %)", [](const SavingResult& r) { return ratioText(r.ratio, 3); }),
      memoryColumn("forced", &SavingResult::forced),
      memoryColumn("without", &SavingResult::without),
      {{"pictures", Align::left},
       [](const SavingResult& r) { return r.applies ? pictureText(r) : "nothing to leave out"; }},
  };
}

nlohmann::ordered_json toJsonValue(const SavingSide& side) {
  nlohmann::ordered_json json{{"frame_ms", side.ms}, {"memory_bytes", side.memoryBytes}};
  if (side.rmse) json["rmse"] = *side.rmse;
  return json;
}

}  // namespace

void comparePictures(SavingResult& result, const Image& forced, const Image& without,
                     const Image* reference) {
  const auto value = [](const Image& image, std::size_t pixel, int channel) {
    return double{
        image.data()[pixel * static_cast<std::size_t>(image.channelCount()) +
                     static_cast<std::size_t>(image.rgbChannels()[static_cast<std::size_t>(channel)])]};
  };
  std::size_t apart = 0;
  for (std::size_t i = 0; i < forced.pixelCount(); ++i) {
    double largest = 0;
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(value(forced, i, c) - value(without, i, c));
      // NaN is above nothing: pictures of it would be called equal.
      largest =
          std::max(largest, std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference);
    }
    result.largestDifference = std::max(result.largestDifference, largest);
    if (largest <= kApart) continue;
    ++apart;
    for (int c = 0; reference && c < 3; ++c) {
      const double truth = value(*reference, i, c);
      result.forced.squaresApart += std::pow(value(forced, i, c) - truth, 2);
      result.without.squaresApart += std::pow(value(without, i, c) - truth, 2);
    }
  }
  result.shareApart = static_cast<double>(apart) / static_cast<double>(forced.pixelCount());
}

bool SavingResult::holds() const {
  if (!applies || largestDifference == 0) return true;
  if (exact) return false;
  const bool near = shareApart == 0 || (forced.rmse && without.squaresApart <= forced.squaresApart);
  return near && (!forced.rmse || *without.rmse <= *forced.rmse * (1 + kErrorTolerance));
}

std::vector<SavingResult> measureSavings(render::Renderer& renderer, const scene::CameraPose& camera,
                                         const render::Settings& settings, const Image* reference,
                                         const SavingOptions& options) {
  std::vector<SavingResult> results;
  std::vector<Comparison> asked = comparisons(settings);
  for (Comparison& c : asked) {
    const auto tell = [&](int step) {
      const double done = static_cast<double>(results.size()) + static_cast<double>(step) / (kTurns + 1);
      if (options.progress) options.progress(done / static_cast<double>(asked.size()), c.result.name);
    };
    tell(0);
    look(c, renderer, camera, reference);
    c.result.applies = applies(c.result, c.forced);
    if (c.result.applies && options.frames > 0)
      time(c, renderer, camera, options, [&](int turn) { tell(turn + 1); });
    results.push_back(std::move(c.result));
  }
  return results;
}

std::string toMarkdown(std::span<const SavingResult> results) {
  static const std::vector<MarkdownColumn<SavingResult>> columns = savingColumns();
  return markdownTable(columns, results);
}

std::string toJson(std::span<const SavingResult> results) {
  nlohmann::ordered_json savings = nlohmann::ordered_json::array();
  for (const SavingResult& r : results) {
    nlohmann::ordered_json json{{"name", r.name}, {"how", r.how}, {"exact", r.exact}, {"applies", r.applies}};
    if (r.applies) {
      json["passes"] = r.passes;
      json["forced"] = toJsonValue(r.forced);
      json["without"] = toJsonValue(r.without);
      json["ratio"] = {r.ratio.value, r.ratio.low, r.ratio.high};
      json["largest_difference"] = r.largestDifference;
      json["share_apart"] = r.shareApart;
      json["holds"] = r.holds();
    }
    savings.push_back(std::move(json));
  }
  return nlohmann::ordered_json{{"savings", savings}}.dump(2);
}

}  // namespace limn::bench
