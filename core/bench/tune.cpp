#include "core/bench/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace limn::bench {
namespace {

// Tuned on the model of tests/unit/bench/bench_tune_test.cpp and on balls and robot (docs/tune.md).
constexpr double kClearlyFaster = 0.9, kClearlyBetter = 0.97;  // a few frames scatter by about a tenth
constexpr double kHopeless = 3;           // another technique is better by this factor in both figures
constexpr double kNearBelow = 2;          // how far from the limit a walk spreads
constexpr double kNearAbove = 2;          // the same above it
constexpr double kLookReach = 1.5;        // how far above the limit a look may be wrong
constexpr double kCheckReach = 1.1;       // the same of a check
constexpr std::size_t kLeastLeading = 2;  // settings of a technique that a walk goes on from
constexpr std::size_t kLeastChecked = 6, kLeastMeasured = 3, kMostMeasured = 12;

std::string valueText(const Parameter& parameter, double value) {
  return parameter.type == ParameterType::integer ? fmt::format("{:.0f}", value)
                                                  : fmt::format("{:.6g}", value);
}

/// The values after the default in one direction, the nearest first.
std::vector<double> stepsFrom(const Parameter& parameter, int steps, double factor) {
  std::vector<double> values;
  double value = parameter.defaultValue, last = value;
  for (int i = 0; i < steps; ++i) {
    value = value == 0 && factor > 1 ? 1 : value * factor;
    double next = std::clamp(value, parameter.range.low, parameter.range.high);
    if (parameter.type == ParameterType::integer) next = std::round(next);
    if (next == last) continue;
    values.push_back(next);
    last = next;
  }
  return values;
}

double logOf(double value) {
  constexpr double least = 1e-12;
  return std::log(std::max(value, least));
}

/// What is known of one setting.
struct Known {
  TuneFigures figures;
  bool checked = false, measured = false;
};

class Search {
 public:
  Search(std::span<const TuneSpace> spaces, const TuneLimit& limit, const TuneMeasure& measure)
      : spaces_(spaces), limit_(limit), measure_(measure) {}

  void walk(const TuneEffort& effort) {
    std::set<TuneSetting> batch;
    for (std::size_t i = 0; i < spaces_.size(); ++i) batch.insert(start(i));
    while (!batch.empty()) {
      result_.looked += batch.size();
      take({batch.begin(), batch.end()}, effort, [](Known&) {});
      batch = neighbours();
    }
  }

  void check(const TuneEffort& effort) {
    const auto open = [](const Known& known) { return !known.checked; };
    const std::vector<TuneSetting> chosen =
        best(std::max(kLeastChecked, (known_.size() + 2) / 3), open, kLookReach);
    result_.checked = chosen.size();
    take(chosen, effort, [](Known& known) { known.checked = true; });
  }

  void measureBest(const TuneEffort& effort) {
    const auto checked = [](const Known& known) { return known.checked && !known.measured; };
    const auto open = [](const Known& known) { return !known.measured; };
    measureAll(
        best(std::clamp((result_.checked + 2) / 3, kLeastMeasured, kMostMeasured), checked, kCheckReach),
        effort);
    while (none()) {  // whatever else may keep the limit
      std::vector<TuneSetting> more = best(kLeastMeasured, open, kLookReach);
      std::erase_if(more, [&](const TuneSetting& s) {
        return constrained(known_.at(s).figures) > kLookReach * bound();
      });
      if (more.empty()) break;
      measureAll(more, effort);
    }
  }

  void measureAll(const std::vector<TuneSetting>& settings, const TuneEffort& effort) {
    result_.measured += settings.size();
    take(settings, effort, [](Known& known) { known.measured = true; });
  }

  TuneResult result() {
    std::vector<TuneSetting> measured;
    for (const auto& [setting, known] : known_)
      if (known.measured && !known.figures.failed) measured.push_back(setting);
    const auto figures = [&](const TuneSetting& s) { return known_.at(s).figures; };
    for (const TuneSetting& s : measured)
      if (keeps(figures(s))) result_.answers.push_back(s);
    std::ranges::stable_sort(result_.answers, {},
                             [&](const TuneSetting& s) { return objective(figures(s)); });
    const auto nearest =
        std::ranges::min_element(measured, {}, [&](const TuneSetting& s) { return constrained(figures(s)); });
    if (nearest != measured.end()) result_.nearest = *nearest;
    return result_;
  }

 private:
  TuneSetting start(std::size_t space) const {
    TuneSetting setting{space, {}};
    for (const TuneAxis& axis : spaces_[space].axes) setting.at.push_back(axis.start);
    return setting;
  }

  double bound() const { return limit_.ms ? *limit_.ms : *limit_.error; }
  double constrained(const TuneFigures& f) const { return limit_.ms ? f.ms : f.error; }
  double objective(const TuneFigures& f) const { return limit_.ms ? f.error : f.ms; }
  bool keeps(const TuneFigures& f) const { return constrained(f) <= bound(); }

  bool none() const {
    return std::ranges::none_of(known_, [&](const auto& entry) {
      const Known& known = entry.second;
      return known.measured && !known.figures.failed && keeps(known.figures);
    });
  }

  template <class Mark>
  void take(const std::vector<TuneSetting>& settings, const TuneEffort& effort, Mark mark) {
    if (settings.empty()) return;
    const std::vector<TuneFigures> figures = measure_(settings, effort);
    for (std::size_t i = 0; i < settings.size(); ++i) {
      Known& known = known_[settings[i]];
      known.figures = figures[i];
      mark(known);
    }
  }

  static bool clearlyBeaten(const TuneFigures& f, const TuneFigures& other) {
    return (other.ms < kClearlyFaster * f.ms && other.error <= f.error) ||
           (other.error < kClearlyBetter * f.error && other.ms <= f.ms);
  }

  static bool hopeless(const TuneFigures& f, const TuneFigures& other) {
    return kHopeless * other.ms < f.ms && kHopeless * other.error < f.error;
  }

  double distance(const TuneFigures& f) const { return std::abs(logOf(constrained(f)) - logOf(bound())); }

  /// Whether nothing says that a better setting is elsewhere: not clearly beaten by one of its own technique,
  /// nor by far by one of another.
  bool promises(const TuneSetting& setting, const TuneFigures& f) const {
    if (f.failed) return false;
    return std::ranges::none_of(known_, [&](const auto& entry) {
      const auto& [other, known] = entry;
      return !known.figures.failed &&
             (other.space == setting.space ? clearlyBeaten(f, known.figures) : hopeless(f, known.figures));
    });
  }

  /// What the walk goes on from: promising settings near the limit, and of each technique those that are
  /// nearest to it.
  std::vector<TuneSetting> leading() const {
    std::vector<std::vector<TuneSetting>> promising(spaces_.size());
    for (const auto& [setting, known] : known_)
      if (promises(setting, known.figures)) promising[setting.space].push_back(setting);
    std::vector<TuneSetting> chosen;
    for (std::vector<TuneSetting>& settings : promising) {
      std::ranges::stable_sort(settings, {},
                               [&](const TuneSetting& s) { return distance(known_.at(s).figures); });
      for (std::size_t i = 0; i < settings.size(); ++i)
        if (i < kLeastLeading || isNear(known_.at(settings[i]).figures)) chosen.push_back(settings[i]);
    }
    return chosen;
  }

  bool isNear(const TuneFigures& f) const {
    return constrained(f) >= bound() / kNearBelow && constrained(f) <= bound() * kNearAbove;
  }

  std::set<TuneSetting> neighbours() const {
    std::set<TuneSetting> next;
    for (const TuneSetting& setting : leading())
      for (std::size_t axis = 0; axis < setting.at.size(); ++axis)
        for (const bool up : {false, true}) {
          TuneSetting other = setting;
          std::size_t& at = other.at[axis];
          if (up ? at + 1 == spaces_[setting.space].axes[axis].values.size() : at == 0) continue;
          at = up ? at + 1 : at - 1;
          if (!known_.contains(other)) next.insert(std::move(other));
        }
    return next;
  }

  /// Up to `count` settings: two thirds are the best of those that keep the limit by what is known, the
  /// others miss it by up to `reach`; those that miss it least fill what is left.
  template <class Open>
  std::vector<TuneSetting> best(std::size_t count, Open open, double reach) const {
    std::vector<TuneSetting> inside, near, beyond;
    for (const auto& [setting, known] : known_) {
      if (known.figures.failed || !open(known)) continue;
      const double c = constrained(known.figures);
      (c <= bound() ? inside : c <= reach * bound() ? near : beyond).push_back(setting);
    }
    const auto byObjective = [&](const TuneSetting& s) { return objective(known_.at(s).figures); };
    const auto byConstrained = [&](const TuneSetting& s) { return constrained(known_.at(s).figures); };
    std::ranges::stable_sort(inside, {}, byObjective);
    std::ranges::stable_sort(near, {}, [&](const TuneSetting& s) {
      const double excess = byConstrained(s) / bound();
      return byObjective(s) * excess * excess;
    });
    std::ranges::stable_sort(beyond, {}, byConstrained);
    const std::size_t least = std::min(near.size(), count / 3);
    const std::size_t first = std::min(inside.size(), count - least);
    std::vector<TuneSetting> chosen(inside.begin(), inside.begin() + static_cast<std::ptrdiff_t>(first));
    for (const std::vector<TuneSetting>* more : {&near, &beyond})
      for (const TuneSetting& setting : *more)
        if (chosen.size() < count) chosen.push_back(setting);
    return chosen;
  }

  std::span<const TuneSpace> spaces_;
  TuneLimit limit_;
  const TuneMeasure& measure_;
  std::map<TuneSetting, Known> known_;
  TuneResult result_;
};

}  // namespace

TuneAxis tuneAxis(const std::string& technique, const Parameter& parameter, int steps) {
  TuneAxis axis{fmt::format("{}.{}", technique, parameter.name), {}, 0};
  switch (parameter.type) {
    case ParameterType::boolean:
      axis.values = {"false", "true"};
      axis.start = parameter.defaultValue != 0 ? 1 : 0;
      break;
    case ParameterType::choice:
      for (int i = 0; i < parameter.choiceCount; ++i) axis.values.emplace_back(parameter.choices[i]);
      axis.start = static_cast<std::size_t>(parameter.defaultValue);
      break;
    case ParameterType::integer:
    case ParameterType::real: {
      const std::vector<double> below = stepsFrom(parameter, steps, 0.5);
      for (auto value = below.rbegin(); value != below.rend(); ++value)
        axis.values.push_back(valueText(parameter, *value));
      axis.start = below.size();
      axis.values.push_back(valueText(parameter, parameter.defaultValue));
      for (const double value : stepsFrom(parameter, steps, 2))
        axis.values.push_back(valueText(parameter, value));
      break;
    }
  }
  return axis;
}

std::size_t settingCount(const TuneSpace& space) {
  std::size_t count = 1;
  for (const TuneAxis& axis : space.axes) count *= axis.values.size();
  return count;
}

std::vector<std::pair<std::string, std::string>> changedParameters(const TuneSpace& space,
                                                                   const TuneSetting& setting) {
  std::vector<std::pair<std::string, std::string>> changed;
  for (std::size_t i = 0; i < space.axes.size(); ++i)
    if (const TuneAxis& axis = space.axes[i]; setting.at[i] != axis.start)
      changed.emplace_back(axis.parameter, axis.values[setting.at[i]]);
  return changed;
}

TunePlan tunePlan(int width, int height, int frames, int turns) {
  constexpr int least = 48;  // pixels of the shorter side: fewer would be mostly silhouettes
  int divisor = 4;
  while (divisor > 1 && std::min(width, height) / divisor < least) divisor /= 2;
  // Rows are known by size, frames and warm-up: those of different efforts must not be taken for each other.
  return {{divisor, 3, 1, 1}, {1, (frames + 1) / 2, 2, (turns + 2) / 3}, {1, frames, 3, turns}};
}

double badness(const MetricInfo& metric, double value) {
  switch (metric.kind) {
    case MetricKind::deviation:
      return std::abs(value);
    case MetricKind::likeness:
      return std::pow(10, -value / 20);
    case MetricKind::error:
    case MetricKind::basis:
      break;
  }
  return value;
}

double msAtPixels(const Row& row, double pixels) {
  const CostSplit& split = row.cost.split;
  const double fixed = split.maps + split.filters, growing = split.technique + split.rest;
  const double now = row.cost.frameMs.median;
  return fixed + growing > 0 ? now * (fixed + growing * pixels) / (fixed + growing) : now * pixels;
}

Ratio frameMsInterval(const Row& row) {
  const FrameTime& time = row.cost.frameMs;
  const std::vector<double> samples = time.samples.empty() ? std::vector<double>{time.median} : time.samples;
  const std::vector<double> one(static_cast<std::size_t>(std::max(time.turns, 1)), 1.0);
  return ratioOfMedians({samples, time.turns}, {one, time.turns});
}

TuneResult tune(std::span<const TuneSpace> spaces, const TuneLimit& limit, const TunePlan& plan,
                const TuneMeasure& measure) {
  Search search(spaces, limit, measure);
  search.walk(plan.look);
  search.check(plan.check);
  search.measureBest(plan.full);
  return search.result();
}

TuneResult tuneExhaustively(std::span<const TuneSpace> spaces, const TuneLimit& limit, const TuneEffort& full,
                            const TuneMeasure& measure) {
  std::vector<TuneSetting> all;
  for (std::size_t space = 0; space < spaces.size(); ++space)
    for (std::size_t i = 0, count = settingCount(spaces[space]); i < count; ++i) {
      TuneSetting setting{space, {}};
      std::size_t rest = i;
      for (const TuneAxis& axis : spaces[space].axes) {
        setting.at.push_back(rest % axis.values.size());
        rest /= axis.values.size();
      }
      all.push_back(std::move(setting));
    }
  Search search(spaces, limit, measure);
  search.measureAll(all, full);
  return search.result();
}

}  // namespace limn::bench
