#include "core/bench/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>

#include "core/base/error.h"
#include "core/base/failure.h"
#include "core/bench/private/comparison.h"
#include "core/image/error_spectrum.h"
#include "core/image/metric_table.h"
#include "core/image/signature.h"
#include "core/question/question_fields.h"
#include "core/question/render_command.h"
#include "core/question/term.h"
#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

Misjudged misjudged(const Image& image, const Reference& reference, const std::vector<unsigned char>& mask) {
  Misjudged count;
  const int v = image.rgbChannels()[0], r = reference.image.rgbChannels()[0];
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const float truth = reference.image.data()[i * static_cast<std::size_t>(reference.image.channelCount()) +
                                               static_cast<std::size_t>(r)];
    const float value =
        image.data()[i * static_cast<std::size_t>(image.channelCount()) + static_cast<std::size_t>(v)];
    const bool umbra = truth < Misjudged::kUmbra;
    const bool lit = truth > Misjudged::kLit;
    count.umbra += umbra;
    count.litInUmbra += umbra && value > Misjudged::kTolerance;
    count.lit += lit;
    count.darkInLight += lit && value < 1 - Misjudged::kTolerance;
  }
  return count;
}

/// Values near the largest float square to infinity, which JSON cannot hold: the row could not be read again.
void requireFinite(std::string_view what, double value) {
  if (!std::isfinite(value))
    throw Error(fmt::format("the {} is not finite; the picture has values too large to be compared", what));
}

void requireFinite(const Metrics& metrics) {
  for (const MetricInfo& info : kMetrics)
    if (!info.unbounded) requireFinite(info.label, metricValue(info, metrics).value_or(0));
}

std::optional<BoundTime> boundTurn(const Case& c, const Callbacks& callbacks) {
  return c.bound && callbacks.bound ? callbacks.bound(c) : std::nullopt;
}

Row measureRow(const Case& c, const std::string& key, const Reference& reference,
               const Callbacks& callbacks) {
  Row row;
  row.what = c;
  row.referenceFile = reference.file;
  row.referenceNoise = reference.noise;
  row.referenceSeconds = reference.seconds;
  Measurement measurement = callbacks.measure(c);
  CompareOptions options;
  options.maxMaskedShare = c.maxMaskedShare;
  options.background = hasBackground(c.term);
  const Comparison comparison = compareImagesDetailed(measurement.image, reference.image, options);
  row.error = comparison.metrics;
  row.spectrum = errorSpectrum(measurement.image, reference.image, comparison.mask);
  if (c.term == name(Term::visibility)) {
    // Lit pixels hide the error of a visibility technique.
    row.penumbra =
        metricsWithin(measurement.image, reference.image, comparison, {Misjudged::kUmbra, Misjudged::kLit});
    row.misjudged = misjudged(measurement.image, reference, comparison.mask);
  }
  requireFinite(row.error);
  if (row.penumbra) requireFinite(*row.penumbra);
  for (const double power : row.spectrum) requireFinite("spectrum of the error", power);
  if (c.picture && callbacks.keepPicture) {
    if (c.technique != kSeparationFloor)  // which no command renders
      sign(measurement.image, renderCommand(c, c.technique, c.parameters) + " --out " + key + ".png");
    row.picture = callbacks.keepPicture(key, measurement.image);
    row.difference = callbacks.keepPicture(key + ".difference", differenceImage(comparison));
  }
  row.cost = std::move(measurement.cost);
  row.cost.bound = boundTurn(c, callbacks);
  return row;
}

void append(std::vector<double>& samples, const std::vector<double>& more) {
  samples.insert(samples.end(), more.begin(), more.end());
}

/// The row with the frames of a further turn, which the case asks for now.
Row withTurn(Row row, const Case& c, const std::vector<double>& ms, const std::optional<BoundTime>& bound) {
  row.what.turns = c.turns;
  if (row.cost.bound && bound) {
    append(row.cost.bound->own, bound->own);
    append(row.cost.bound->bound, bound->bound);
    ++row.cost.bound->turns;
  }
  FrameTime& time = row.cost.frameMs;
  append(time.samples, ms);
  const render::Quartiles all = render::quartiles(time.samples);
  time = {all.median, all.q1, all.q3, all.n, std::move(time.samples), time.turns + 1};
  return row;
}

/// Whether the row is good, has what the case asks for beside its key, and was measured with what the case is
/// measured with now.
bool isValid(const Row& row, const Case& c, const std::function<Provenance(const Case&)>& provenance) {
  return row.failure.empty() && (!c.picture || !row.picture.empty()) &&
         row.error.masked_share <= c.maxMaskedShare &&
         (!provenance || staleness(row.provenance, provenance(c)).empty());
}

bool hasAllTurns(const Row& row, const Case& c) {
  return row.cost.frameMs.n == 0 || row.cost.frameMs.turns >= c.turns;
}

/// Brings what the suite says of a row, and nothing was measured of, to what it says now.
void restate(const Row& row, const Case& c, ResultsFile& results) {
  const auto said = [](const Case& of) { return std::tie(of.title, of.baseline, of.maxMaskedShare); };
  if (said(row.what) == said(c)) return;
  Row now = row;
  now.what.title = c.title;
  now.what.baseline = c.baseline;
  now.what.maxMaskedShare = c.maxMaskedShare;
  results.append(now);
}

class Run {
 public:
  Run(std::span<const Case> cases, const std::string& renderer, ResultsFile& results,
      const Callbacks& callbacks)
      : cases_(cases), renderer_(renderer), results_(results), callbacks_(callbacks) {
    for (const Case& c : cases) turns_ = std::max(turns_, c.turns);
  }

  Summary all() {
    for (place_ = 0; place_ < cases_.size(); ++place_) measure(place_);
    if (turns_ > 1) retimeAll();
    summary_.shortened = shortenedRows(cases_, renderer_, results_.rows());
    return summary_;
  }

 private:
  void report(std::size_t i, int turn, Progress::State state, const std::string& failure = "") const {
    if (!callbacks_.progress) return;
    callbacks_.progress({static_cast<int>(i), static_cast<int>(cases_.size()), static_cast<int>(place_), turn,
                         turns_, cases_[i], state, failure});
  }

  void append(Row row, const std::string& key) {
    row.key = key;
    row.cost.renderer = renderer_;
    row.provenance = provenanceOf(row.what);
    results_.append(row);
  }

  Provenance provenanceOf(const Case& c) const {
    return callbacks_.provenance ? callbacks_.provenance(c) : Provenance();
  }

  /// Whether further turns may be added to the row.
  bool isOfThisMachine(const Row& row) const {
    return mayBeEqual(row.cost.machine, callbacks_.machine) && mayBeEqual(row.cost.driver, callbacks_.driver);
  }

  /// The row that holds for the case as it is now, null if there is none.
  const Row* finished(const Case& c, const std::string& key) const {
    const Row* row = results_.find(key);
    const bool holds = row && isValid(*row, c, callbacks_.provenance) &&
                       (isOfThisMachine(*row) || (!callbacks_.hereAlone && hasAllTurns(*row, c)));
    return holds ? row : nullptr;
  }

  void measure(std::size_t i) {
    const Case& c = cases_[i];
    const std::string key = rowKey(c, renderer_);
    if (const Row* row = finished(c, key)) {
      restate(*row, c, results_);
      ++summary_.skipped;
      return report(i, 1, Progress::State::skipped);
    }
    report(i, 1, Progress::State::started);
    Row row;
    try {
      if (!reference_ || referenceQuestion_ != question(c) || (c.picture && !referencePictured_)) {
        reference_.reset();
        reference_ = callbacks_.reference(c);
        referenceQuestion_ = question(c);
        referencePictured_ = c.picture;
      }
      row = measureRow(c, key, *reference_, callbacks_);
    } catch (...) {
      row = Row{};
      row.what = c;
      row.failure = currentFailure();
    }
    append(row, key);
    ++(row.failure.empty() ? summary_.done : summary_.failed);
    report(i, 1, row.failure.empty() ? Progress::State::done : Progress::State::failed, row.failure);
  }

  /// Returns the cases in the order of further turns.
  std::vector<std::size_t> byScene() const {
    std::map<std::string, std::size_t> known;
    std::vector<std::vector<std::size_t>> scenes;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      SceneQuestion scene = cases_[i];
      for (const QuestionEffect effect : {QuestionEffect::view, QuestionEffect::time, QuestionEffect::lights})
        copyFields(effect, scene, SceneQuestion());
      const auto [place, isNew] = known.emplace(questionText(scene), scenes.size());
      if (isNew) scenes.emplace_back();
      scenes[place->second].push_back(i);
    }
    std::vector<std::size_t> order;
    for (const std::vector<std::size_t>& scene : scenes)
      order.insert(order.end(), scene.begin(), scene.end());
    return order;
  }

  void retimeAll() {
    const std::vector<std::size_t> order = byScene();
    for (int turn = 2; turn <= turns_; ++turn)
      for (place_ = 0; place_ < order.size(); ++place_) retime(order[place_], turn);
  }

  void retime(std::size_t i, int turn) {
    const Case& c = cases_[i];
    const std::string key = rowKey(c, renderer_);
    const Row* row = finished(c, key);
    if (!row || row->cost.frameMs.n == 0 || turn > c.turns) return;
    if (row->cost.frameMs.turns >= turn) return;
    report(i, turn, Progress::State::started);
    std::vector<double> ms;
    std::optional<BoundTime> bound;
    try {
      ms = callbacks_.time(c);
      bound = boundTurn(c, callbacks_);
    } catch (...) {  // the row stays as it is
      return report(i, turn, Progress::State::failed, currentFailure());
    }
    append(withTurn(*row, c, ms, bound), key);
    report(i, turn, Progress::State::done);
  }

  std::span<const Case> cases_;
  const std::string& renderer_;
  ResultsFile& results_;
  const Callbacks& callbacks_;
  int turns_ = 1;
  std::size_t place_ = 0;  ///< of the case that is looked at, in its turn
  Summary summary_;
  std::optional<Reference> reference_;
  std::string referenceQuestion_;
  bool referencePictured_ = false;  ///< its picture was kept, too
};

}  // namespace

std::map<std::string, int> staleRows(std::span<const Case> cases, const std::string& renderer,
                                     const ResultsFile& results,
                                     const std::function<Provenance(const Case&)>& provenance) {
  std::map<std::string, int> counts;
  for (const Case& c : cases) {
    const std::string key = rowKey(c, renderer);
    if (!results.contains(key)) continue;
    const std::string reason = staleness(results.find(key)->provenance, provenance(c));
    if (!reason.empty()) ++counts[reason];
  }
  return counts;
}

int shortenedRows(std::span<const Case> cases, const std::string& renderer, std::span<const Row> rows) {
  std::map<std::string, const Row*> known;
  for (const Row& row : rows) known.emplace(row.key, &row);
  return static_cast<int>(std::ranges::count_if(cases, [&](const Case& c) {
    const auto found = known.find(rowKey(c, renderer));
    return found != known.end() && found->second->failure.empty() && !hasAllTurns(*found->second, c);
  }));
}

std::vector<Case> unfinishedCases(std::span<const Case> cases, std::span<const Row> rows,
                                  const std::function<Provenance(const Case&)>& provenance) {
  std::multimap<std::string, const Row*> known;
  for (const Row& row : rows) known.emplace(rowKey(row.what, ""), &row);
  std::vector<Case> left;
  for (const Case& c : cases) {
    const auto [begin, end] = known.equal_range(rowKey(c, ""));
    const bool finished = std::any_of(begin, end, [&](const auto& entry) {
      return isValid(*entry.second, c, provenance) && hasAllTurns(*entry.second, c);
    });
    if (!finished) left.push_back(c);
  }
  return left;
}

void restateRows(std::span<const Case> cases, ResultsFile& results,
                 const std::function<Provenance(const Case&)>& provenance) {
  std::map<std::string, const Case*> asked;
  for (const Case& c : cases) asked.emplace(rowKey(c, ""), &c);
  for (const Row& row : results.rows()) {
    const auto found = asked.find(rowKey(row.what, ""));
    if (found != asked.end() && isValid(row, *found->second, provenance))
      restate(row, *found->second, results);
  }
}

Summary runCases(std::span<const Case> cases, const std::string& renderer, ResultsFile& results,
                 const Callbacks& callbacks) {
  return Run(cases, renderer, results, callbacks).all();
}

}  // namespace limn::bench
