#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/bench/private/tune_allowance.h"
#include "core/bench/tune.h"

namespace limn::bench {
namespace {

// Tuned on the model of tests/unit/bench/bench_tune_test.cpp and on grids of balls, chess and frog
// (docs/tune.md).
constexpr double kClearlyFaster = 0.9, kClearlyBetter = 0.97;  // a few frames scatter by about a tenth
constexpr double kHopeless = 3;           // another technique is better by this factor in both figures
constexpr double kBehind = 0.8;           // another technique keeps the limit and is better by this factor
constexpr double kNearBelow = 2;          // how far from the limit a walk spreads
constexpr double kNearAbove = 2;          // the same above it
constexpr double kLookReach = 1.5;        // how far above the limit a look may be wrong
constexpr double kCheckReach = 1.1;       // the same of a check
constexpr std::size_t kLeastLeading = 2;  // settings of a technique that a walk goes on from
constexpr double kMostAtOnce = 64;        // looks between two steps: more of them would be near the defaults
constexpr std::size_t kMostMeasured = 12;

// A predicted setting that misses the limit by a factor x counts as x to this power: errors are predicted
// more exactly than times.
constexpr double kLateWeight = 2, kWrongWeight = 4;

constexpr double kLeast = 1e-12;    // figures below are taken for it
constexpr double kRounding = 1e-9;  // of costs: those that fit exactly do fit

double logOf(double value) {
  return std::log(std::max(value, kLeast));
}

/// What is known of one setting.
struct Known {
  TuneFigures figures;
  bool checked = false, measured = false;
};

/// What is expected one step from a known setting: the figures of that one where nothing can be predicted.
struct Step {
  TuneFigures figures;
  bool predicted = false;
};

class Search {
 public:
  Search(std::span<const TuneSpace> spaces, const TuneLimit& limit, const TuneMeasure& measure)
      : spaces_(spaces), limit_(limit), measure_(measure) {}

  /// Looks at up to `count` settings.
  void walk(const TuneEffort& effort, std::size_t count) {
    std::vector<TuneSetting> batch;
    for (std::size_t i = 0; i < spaces_.size(); ++i) batch.push_back(start(i));
    while (!batch.empty()) {
      result_.looked += batch.size();
      take(batch, effort, [](Known&) {});
      const double left = std::max(0.0, static_cast<double>(count) - looksSpent());
      batch = likeliest(neighbours(), std::min(std::ceil(left / 2), kMostAtOnce));
    }
  }

  /// Checks up to `most` settings.
  void check(const TuneEffort& effort, std::size_t most) {
    if (most == 0) return;
    const auto open = [](const Known& known) { return !known.checked; };
    const std::vector<TuneSetting> chosen = affordable(
        best(known_, std::min(std::max(kLeastChecked, (known_.size() + 2) / 3), most), open, kLookReach),
        most);
    result_.checked = chosen.size();
    take(chosen, effort, [](Known& known) { known.checked = true; });
  }

  /// Measures up to `count` settings in full, and more where none of these keeps the limit.
  void measureBest(const TuneEffort& effort, std::size_t count) {
    const bool afterCheck = result_.checked > 0;
    const auto known = [&](const Known& k) { return k.checked == afterCheck && !k.measured; };
    const auto open = [](const Known& k) { return !k.measured; };
    const std::size_t third = (result_.checked + 2) / 3;
    const std::size_t most = std::clamp(afterCheck ? third : count, kLeastMeasured, kMostMeasured);
    measureAll(affordable(best(known_, most, known, afterCheck ? kCheckReach : kLookReach), count), effort);
    while (none()) {  // whatever else may keep the limit
      std::vector<TuneSetting> more = best(known_, kLeastMeasured, open, kLookReach);
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
                             [&](const TuneSetting& s) { return objectiveFirst(figures(s)); });
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
  /// Errors below the reference's noise are all the same: the quicker of equals comes first.
  std::pair<double, double> objectiveFirst(const TuneFigures& f) const {
    return {objective(f), constrained(f)};
  }
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

  /// The mean time of all settings, taking the factors that single steps from the defaults change it by to
  /// multiply where steps are combined. Axes of which no step is known count as if they changed nothing.
  double meanMs() const {
    double sum = 0, settings = 0;
    for (std::size_t space = 0; space < spaces_.size(); ++space) {
      const TuneFigures* defaults = figuresOf(start(space));
      if (defaults == nullptr) continue;
      const double before = std::max(defaults->ms, kLeast);
      double ms = before;
      for (std::size_t axis = 0; axis < spaces_[space].axes.size(); ++axis) {
        double factors = 0, known = 0;
        for (std::size_t at = 0; at < spaces_[space].axes[axis].values.size(); ++at)
          if (const TuneFigures* f = alone(space, axis, at)) {
            factors += f->ms / before;
            ++known;
          }
        ms *= factors / known;
      }
      const auto count = static_cast<double>(settingCount(spaces_[space]));
      sum += count * ms;
      settings += count;
    }
    return settings > 0 ? std::max(sum / settings, kLeast) : 1;
  }

  /// Whether it differs from the defaults on one axis at most.
  bool isOfStar(const TuneSetting& setting) const {
    const TuneSetting defaults = start(setting.space);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < setting.at.size(); ++i) differing += setting.at[i] != defaults.at[i];
    return differing <= 1;
  }

  /// What a measurement costs, in those of a setting of the mean time: never less than what each costs once,
  /// which is a third of a look (tune_allowance.cpp).
  static double priceOf(const TuneFigures& f, double mean) {
    constexpr double once = 1.0 / 3;
    return f.failed ? 1 : std::max(f.ms / mean, once);
  }

  /// What the looks have cost, in those at a setting of mean time.
  double looksSpent() const {
    const double mean = meanMs();
    double spent = 0;
    for (const auto& [setting, known] : known_) spent += priceOf(known.figures, mean);
    return spent;
  }

  /// The first of them that cost no more together than `count` settings of mean time; a few at any rate.
  std::vector<TuneSetting> affordable(std::vector<TuneSetting> settings, std::size_t count) const {
    const double mean = meanMs();
    double spent = 0;
    std::size_t kept = 0;
    for (; kept < settings.size(); ++kept) {
      spent += priceOf(known_.at(settings[kept]).figures, mean);
      if (kept >= kLeastMeasured && spent > static_cast<double>(count)) break;
    }
    settings.resize(kept);
    return settings;
  }

  /// Settings one step from those that the walk goes on from, with what is expected of them; of all others
  /// that are known, those of which something can be predicted: a quick setting far from the limit may be one
  /// step from the answer. The defaults remain among the former, beaten or not: what single steps change is
  /// what all predictions are made of.
  std::map<TuneSetting, Step> neighbours() const {
    std::map<TuneSetting, Step> next;
    const auto addFrom = [&](const TuneSetting& setting, bool unpredicted) {
      for (std::size_t axis = 0; axis < setting.at.size(); ++axis)
        for (const bool up : {false, true}) {
          TuneSetting other = setting;
          std::size_t& at = other.at[axis];
          if (up ? at + 1 == spaces_[setting.space].axes[axis].values.size() : at == 0) continue;
          at = up ? at + 1 : at - 1;
          if (known_.contains(other)) continue;
          const std::optional<TuneFigures> figures = predicted(other, setting, axis);
          if (figures || unpredicted)
            next.emplace(std::move(other),
                         Step{figures.value_or(known_.at(setting).figures), figures.has_value()});
        }
    };
    for (const TuneSetting& setting : leading()) addFrom(setting, true);
    for (std::size_t space = 0; space < spaces_.size(); ++space)
      if (const TuneFigures* f = figuresOf(start(space)); f != nullptr && !isBehind(space, *f))
        addFrom(start(space), true);
    for (const auto& [setting, known] : known_)
      if (!known.figures.failed) addFrom(setting, false);
    return next;
  }

  /// What is known of a setting; null where nothing is or it failed.
  const TuneFigures* figuresOf(const TuneSetting& setting) const {
    const auto found = known_.find(setting);
    return found != known_.end() && !found->second.figures.failed ? &found->second.figures : nullptr;
  }

  /// The same of the defaults but for one axis.
  const TuneFigures* alone(std::size_t space, std::size_t axis, std::size_t at) const {
    TuneSetting setting = start(space);
    setting.at[axis] = at;
    return figuresOf(setting);
  }

  /// What a step changes beside the defaults, it is taken to change elsewhere; nothing where that is not
  /// known.
  std::optional<TuneFigures> predicted(const TuneSetting& setting, const TuneSetting& origin,
                                       std::size_t axis) const {
    const TuneFigures* from = alone(setting.space, axis, origin.at[axis]);
    const TuneFigures* to = alone(setting.space, axis, setting.at[axis]);
    if (from == nullptr || to == nullptr) return std::nullopt;
    TuneFigures f = known_.at(origin).figures;
    f.error *= to->error / std::max(from->error, kLeast);
    f.ms *= to->ms / std::max(from->ms, kLeast);
    return f;
  }

  /// Whether a setting of another technique keeps the limit, and this one misses it by far or is worse: steps
  /// from here come last.
  bool isBehind(std::size_t space, const TuneFigures& f) const {
    return std::ranges::any_of(known_, [&](const auto& entry) {
      const auto& [other, known] = entry;
      return other.space != space && !known.figures.failed && keeps(known.figures) &&
             (constrained(f) > kNearAbove * bound() || objective(known.figures) < kBehind * objective(f));
    });
  }

  /// How little is to be expected of steps from a setting: the objective where it keeps the limit, and after
  /// those how far it misses it.
  std::pair<bool, double> lateness(const TuneFigures& f) const {
    return keeps(f) ? std::pair(false, objective(f)) : std::pair(true, distance(f));
  }

  /// How little is to be expected of predicted figures: the objective, which counts for far less where they
  /// miss the limit.
  std::pair<bool, double> predictedLateness(const TuneFigures& f) const {
    const double excess = std::max(1.0, constrained(f) / bound());
    return {excess > kLookReach, objective(f) * std::pow(excess, limit_.ms ? kLateWeight : kWrongWeight)};
  }

  /// Those that cost no more together than `count` of mean time: single steps from the defaults of which
  /// nothing can be predicted, in techniques that none is ahead of; then the best by what is predicted; where
  /// there is neither, other steps of which nothing can be predicted.
  std::vector<TuneSetting> likeliest(const std::map<TuneSetting, Step>& steps, double count) const {
    std::vector<TuneSetting> predictable, ahead, behind;
    for (const auto& [setting, step] : steps) {
      if (step.predicted)
        predictable.push_back(setting);
      else
        (isOfStar(setting) && !isBehind(setting.space, step.figures) ? ahead : behind).push_back(setting);
    }
    const auto figures = [&](const TuneSetting& s) { return steps.at(s).figures; };
    std::ranges::stable_sort(ahead, {}, [&](const TuneSetting& s) { return lateness(figures(s)); });
    std::ranges::stable_sort(predictable, {},
                             [&](const TuneSetting& s) { return predictedLateness(figures(s)); });
    const double mean = meanMs();
    std::vector<TuneSetting> chosen;
    const auto add = [&](const std::vector<TuneSetting>& more) {
      for (const TuneSetting& setting : more) {
        const double cost = priceOf(figures(setting), mean);
        if (cost > (1 + kRounding) * count) continue;  // a cheaper one may fit
        count -= cost;
        chosen.push_back(setting);
      }
    };
    add(ahead);
    add(predictable);
    if (chosen.empty()) add(behind);
    return chosen;
  }

  /// Up to `count` settings: two thirds are the best of those that keep the limit by these figures, the
  /// others miss it by up to `reach`; those that miss it least fill what is left.
  template <class Open>
  std::vector<TuneSetting> best(const std::map<TuneSetting, Known>& of, std::size_t count, Open open,
                                double reach) const {
    std::vector<TuneSetting> inside, near, beyond;
    for (const auto& [setting, known] : of) {
      if (known.figures.failed || !open(known)) continue;
      const double c = constrained(known.figures);
      (c <= bound() ? inside : c <= reach * bound() ? near : beyond).push_back(setting);
    }
    const auto byObjective = [&](const TuneSetting& s) { return objective(of.at(s).figures); };
    const auto byConstrained = [&](const TuneSetting& s) { return constrained(of.at(s).figures); };
    std::ranges::stable_sort(inside, {},
                             [&](const TuneSetting& s) { return objectiveFirst(of.at(s).figures); });
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

TuneResult tune(std::span<const TuneSpace> spaces, const TuneLimit& limit, const TunePlan& plan,
                const TuneMeasure& measure) {
  Search search(spaces, limit, measure);
  const TuneAllowance allowance = allowanceOf(spaces, plan);
  search.walk(plan.look, allowance.looks);
  search.check(plan.check, allowance.checks);
  search.measureBest(plan.full, allowance.measured);
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
