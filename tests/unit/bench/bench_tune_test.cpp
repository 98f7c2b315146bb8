// The search for settings, on models of error and cost whose best answer is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bench/tune.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn::bench {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(TuneAxis, StepsByFactorsOfTwoAroundTheDefaultAndEndsAtTheRange) {
  const TuneAxis samples = tuneAxis("pcss", integer("samples", 32, {1, 4096}, "", ""), 2);
  EXPECT_EQ(samples.parameter, "pcss.samples");
  EXPECT_THAT(samples.values, ElementsAre("8", "16", "32", "64", "128"));
  EXPECT_EQ(samples.start, 2u);
  const TuneAxis height = tuneAxis("vssm", integer("tree_height", 3, {1, 5}, "", ""), 2);
  EXPECT_THAT(height.values, ElementsAre("1", "2", "3", "5"));
  EXPECT_EQ(height.start, 2u);
  const TuneAxis views = tuneAxis("vssm", integer("views", 0, {0, 8}, "", ""), 2);
  EXPECT_THAT(views.values, ElementsAre("0", "1", "2"));
  EXPECT_EQ(views.start, 0u);
  const TuneAxis tolerance = tuneAxis("t", real("tolerance", 0.1, {0.06, 1}, "", ""), 2);
  EXPECT_THAT(tolerance.values, ElementsAre("0.06", "0.1", "0.2", "0.4"));
  static constexpr const char* kPoints[] = {"64", "128", "256"};
  const TuneAxis points = tuneAxis("t", choice("points", 1, kPoints, ""), 1);
  EXPECT_THAT(points.values, ElementsAre("64", "128", "256"));
  EXPECT_EQ(points.start, 1u);
}

TEST(TuneSpace, NamesOnlyWhatIsNotTheDefault) {
  const TuneSpace space{"t", {{"t.a", {"1", "2", "4"}, 1}, {"t.b", {"8", "16"}, 0}}};
  EXPECT_EQ(settingCount(space), 6u);
  EXPECT_THAT(changedParameters(space, {0, {1, 0}}), testing::IsEmpty());
  EXPECT_THAT(changedParameters(space, {0, {2, 1}}), ElementsAre(Pair("t.a", "4"), Pair("t.b", "16")));
}

TEST(TuneSpace, CountsNoGridAsASmallOneThatIsLargerThanNumbersAre) {
  TuneSpace space{"t", {}};
  for (int axis = 0; axis < 16; ++axis)
    space.axes.push_back({"t.a", std::vector<std::string>(16, "1"), 0});  // 2 to the power 64
  EXPECT_EQ(settingCount(space), std::numeric_limits<std::size_t>::max());
}

TEST(TunePlan, LooksAtSmallPicturesThatAreNotMostlySilhouettes) {
  EXPECT_EQ(tunePlan(1280, 720, 10, 5).look.divisor, 4);
  EXPECT_EQ(tunePlan(256, 192, 10, 5).look.divisor, 2);
  EXPECT_EQ(tunePlan(128, 96, 10, 5).look.divisor, 1);
  EXPECT_EQ(scaleOf(tunePlan(1280, 720, 10, 5)).divisor, 1);
  EXPECT_EQ(scaleOf(tunePlan(1280, 720, 10, 5)).frames, tunePlan(1280, 720, 10, 5).look.frames);
}

TEST(TunePlan, ChecksTakeAFractionOfTheFullEffort) {
  EXPECT_EQ(tunePlan(64, 48, 10, 5).check.frames, 5);
  EXPECT_EQ(tunePlan(64, 48, 10, 5).check.turns, 2);
  EXPECT_EQ(tunePlan(64, 48, 5, 3).check.frames, 3);
  EXPECT_EQ(tunePlan(64, 48, 5, 3).check.turns, 1);
  EXPECT_EQ(tunePlan(64, 48, 1, 1).check.frames, 1);
  EXPECT_EQ(tunePlan(64, 48, 1, 1).check.turns, 1);
}

TEST(TuneFigures, AreSmallerForBetterPictures) {
  const auto metric = [](double Metrics::*member) -> const MetricInfo& { return metricInfo(member); };
  EXPECT_DOUBLE_EQ(badness(metric(&Metrics::rmse), 0.25), 0.25);
  EXPECT_DOUBLE_EQ(badness(metric(&Metrics::bias), -0.25), 0.25);
  EXPECT_NEAR(badness(metric(&Metrics::psnr), 40), 0.01, 1e-15);
  EXPECT_EQ(badness(metric(&Metrics::psnr), std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(badness(metric(&Metrics::psnr), -std::numeric_limits<double>::infinity()),
            std::numeric_limits<double>::infinity());
}

TEST(TuneFigures, NothingRanksBelowTheNoise) {
  const MetricInfo& rmse = metricInfo(&Metrics::rmse);
  Metrics slow, fast;
  slow.rmse = 0.0015;
  fast.rmse = 0.00155;
  slow.noise_floor = fast.noise_floor = 0.002;
  EXPECT_EQ(badness(rmse, slow), 0.002);
  EXPECT_EQ(badness(rmse, fast), 0.002);
  fast.rmse = 0.003;
  EXPECT_EQ(badness(rmse, fast), 0.003);
}

TEST(TuneFigures, TheQuickerOfEqualsIsTheAnswer) {
  const TuneSpace spaces[] = {{"slow", {}}, {"fast", {}}, {"late", {}}};
  const auto measure = [](std::span<const TuneSetting> settings, const TuneEffort&) {
    std::vector<TuneFigures> figures;
    for (const TuneSetting& s : settings)
      figures.push_back({0.002, s.space == 0 ? 200.0 : s.space == 1 ? 20.0 : 300.0});
    return figures;
  };
  const TuneResult result = tuneExhaustively(spaces, {.ms = 250}, {1, 10, 3, 5}, measure);
  ASSERT_EQ(result.answers.size(), 2u);
  EXPECT_EQ(result.answers.front().space, 1u);
}

TEST(TuneFigures, OnlyWhatGrowsWithPixelsIsScaled) {
  Row row = test::exampleRow(test::exampleCase(), 0.1, 8);
  row.cost.split = {3, 1, 3, 1};
  EXPECT_DOUBLE_EQ(msAtPixels(row, 1, 1), 8);
  EXPECT_DOUBLE_EQ(msAtPixels(row, 16, 2), 4 + 3 * 16 + 2);
  EXPECT_DOUBLE_EQ(msAtPixels(row, 1, 16), 8) << "measured as it is asked for";
  const Ratio interval = frameMsInterval(row);
  EXPECT_DOUBLE_EQ(interval.value, 8);
  EXPECT_LT(interval.low, 8);
  EXPECT_GT(interval.high, 8);
}

/// A number from -1 to 1, the same for the same setting and effort.
double scatter(const TuneSetting& setting, const TuneEffort& effort) {
  unsigned hash = 2166136261u;
  const auto mix = [&](std::size_t value) { hash = (hash ^ static_cast<unsigned>(value)) * 16777619u; };
  mix(setting.space);
  for (const std::size_t at : setting.at) mix(at);
  mix(static_cast<std::size_t>(effort.frames * effort.turns));
  hash ^= hash >> 15;
  hash *= 2246822519u;
  hash ^= hash >> 13;
  return static_cast<double>(hash) / 2147483648.0 - 1;
}

/// Techniques whose error falls and whose time grows with each parameter, as soft-shadow techniques do: each
/// parameter takes its part of the error away to a power, and costs a share of the frame.
class Model {
 public:
  struct Parameter {
    double error, power, ms;
  };
  struct Technique {
    double floor, base;  ///< error and milliseconds that no parameter changes
    std::vector<Parameter> parameters;
  };

  /// Numbers have their default and `steps` values on each side.
  explicit Model(std::vector<Technique> techniques, int steps = 2)
      : techniques_(std::move(techniques)), steps_(steps) {
    for (const Technique& technique : techniques_) {
      TuneSpace& space = spaces_.emplace_back();
      space.technique = "t";
      for (std::size_t i = 0; i < technique.parameters.size(); ++i)
        space.axes.push_back({"t.p", std::vector<std::string>(at(2 * steps + 1), "value"), at(steps)});
    }
  }

  TuneFigures truth(const TuneSetting& setting) const {
    const Technique& technique = techniques_[setting.space];
    double squared = technique.floor * technique.floor, ms = technique.base;
    for (std::size_t i = 0; i < setting.at.size(); ++i) {
      const Parameter& parameter = technique.parameters[i];
      const double value = std::exp2(static_cast<double>(setting.at[i]) - steps_);
      squared += std::pow(parameter.error * std::pow(value, -parameter.power), 2);
      ms += parameter.ms * value;
    }
    return {std::sqrt(squared), ms};
  }

  /// The same as it is measured: times scatter, and small pictures mislead.
  std::vector<TuneFigures> measure(std::span<const TuneSetting> settings, const TuneEffort& effort) {
    std::vector<TuneFigures> figures;
    const double spread = 0.3 / std::sqrt(effort.frames * effort.turns);
    for (const TuneSetting& setting : settings) {
      TuneFigures f = truth(setting);
      const double frames =
          1 + effort.warmup + 2 * effort.frames + (effort.turns - 1) * (effort.warmup + effort.frames);
      const double pixels = 1.0 / (effort.divisor * effort.divisor);
      cost_ += frames * f.ms * (0.5 + 0.5 * pixels);  // half of a frame is maps
      f.ms *= 1 + spread * scatter(setting, effort);
      if (effort.divisor > 1) f.error *= 1 + 0.1 * scatter({setting.space, {}}, effort);
      figures.push_back(f);
    }
    return figures;
  }

  std::span<const TuneSpace> spaces() const { return spaces_; }
  double cost() const { return cost_; }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  std::vector<Technique> techniques_;
  int steps_;
  std::vector<TuneSpace> spaces_;
  double cost_ = 0;
};

Model softShadows(int steps) {
  return Model({{0.004, 6, {{0.004, 0.5, 2}, {0.012, 0.5, 6}, {0.006, 1, 3}}},
                {0.012, 5, {{0.006, 0.5, 1}, {0.01, 1, 4}, {0.004, 0.7, 2}}},
                {0.02, 4, {{0.02, 0.5, 1}}},
                {0.002, 5, {{0.03, 0.8, 40}, {0.004, 1, 20}}},
                {0.006, 8, {{0.01, 0.3, 2}, {0.008, 0.5, 2}, {0.005, 1, 4}, {0.003, 0.5, 1}}}},
               steps);
}

/// One technique with a grid of 15625 settings.
Model manyParameters() {
  return Model(
      {{0.004,
        5,
        {{0.02, 0.5, 2}, {0.012, 0.5, 6}, {0.006, 1, 3}, {0.01, 0.3, 2}, {0.008, 0.5, 4}, {0.004, 0.7, 1}}}});
}

/// The best figure of the exhaustive grid, and its cost.
std::pair<double, double> bestOfGrid(const TuneLimit& limit, const TuneEffort& full, Model model) {
  const auto exactly = [&](std::span<const TuneSetting> settings, const TuneEffort& effort) {
    model.measure(settings, effort);
    std::vector<TuneFigures> figures;
    for (const TuneSetting& setting : settings) figures.push_back(model.truth(setting));
    return figures;
  };
  const TuneResult grid = tuneExhaustively(model.spaces(), limit, full, exactly);
  const TuneFigures best = model.truth(grid.answers.at(0));
  return {limit.ms ? best.error : best.ms, model.cost()};
}

/// `counted` is the part of the grid whose cost says what a search may take.
void expectNearTheGrid(const TuneLimit& limit, const TunePlan& plan = tunePlan(640, 480, 10, 5),
                       Model model = softShadows(2), double counted = 1) {
  const auto [best, gridCost] = bestOfGrid(limit, plan.full, model);
  const auto measured = [&](std::span<const TuneSetting> settings, const TuneEffort& effort) {
    return model.measure(settings, effort);
  };
  const TuneResult result = tune(model.spaces(), limit, plan, measured);
  ASSERT_FALSE(result.answers.empty());
  const TuneFigures answer = model.truth(result.answers.front());
  EXPECT_LE(limit.ms ? answer.error : answer.ms, 1.1 * best)
      << limit.ms.value_or(0) << " ms, error " << limit.error.value_or(0);
  // What is measured in full still scatters by a few percent.
  if (limit.ms)
    EXPECT_LE(answer.ms, 1.05 * *limit.ms);
  else
    EXPECT_LE(answer.error, *limit.error);
  EXPECT_LE(model.cost(), 0.15 * counted * gridCost)
      << result.looked << " " << result.checked << " " << result.measured;
}

TEST(Tune, FindsTheLeastErrorOfTheGridAtASmallPartOfItsCost) {
  for (const double ms : {8.0, 12.0, 20.0, 40.0, 100.0}) expectNearTheGrid({.ms = ms});
}

TEST(Tune, FindsTheLeastTimeOfTheGridAtASmallPartOfItsCost) {
  for (const double error : {0.009, 0.012, 0.015, 0.02, 0.03}) expectNearTheGrid({.error = error});
}

// Of 147 settings, whose checks cost nearly half as much as full measurements do. Times of 3 frames in 2
// turns scatter by 12 % themselves.
TEST(Tune, KeepsToASmallPartOfTheCostOfSmallGridsToo) {
  for (const double error : {0.012, 0.015, 0.02, 0.025, 0.03}) {
    expectNearTheGrid({.error = error}, tunePlan(128, 96, 10, 5), softShadows(1));
    expectNearTheGrid({.error = error}, tunePlan(128, 96, 5, 3), softShadows(1));
    expectNearTheGrid({.error = error}, tunePlan(128, 96, 3, 2), softShadows(1));
  }
  for (const double ms : {12.0, 20.0, 40.0, 100.0})
    expectNearTheGrid({.ms = ms}, tunePlan(128, 96, 10, 5), softShadows(1));
}

// 15 % of this grid would be thousands of settings. The least limit is kept by 75 of the 15625, all of them
// seven steps from the defaults or more.
TEST(Tune, LargeGridsCostNoMoreThanAThousandOfTheirSettings) {
  const auto expectCheap = [](const TuneLimit& limit) {
    expectNearTheGrid(limit, tunePlan(640, 480, 10, 5), manyParameters(), 1000.0 / 15625);
  };
  for (const double ms : {12.0, 20.0, 30.0}) expectCheap({.ms = ms});
  for (const double error : {0.02, 0.03}) expectCheap({.error = error});
}

/// Techniques of which each value of a parameter multiplies time and error. The default is the middle one of
/// three values, the first of two, and changes nothing.
class Factors {
 public:
  struct Change {
    double ms, error;
  };
  struct Technique {
    Change base;
    std::vector<std::vector<Change>> axes;
  };

  explicit Factors(std::vector<Technique> techniques) : techniques_(std::move(techniques)) {
    for (const Technique& technique : techniques_) {
      TuneSpace& space = spaces_.emplace_back();
      for (const std::vector<Change>& axis : technique.axes)
        space.axes.push_back(
            {"t.p", std::vector<std::string>(axis.size(), "value"), axis.size() == 3 ? 1u : 0u});
    }
  }

  TuneFigures truth(const TuneSetting& setting) const {
    TuneFigures f{techniques_[setting.space].base.error, techniques_[setting.space].base.ms};
    for (std::size_t i = 0; i < setting.at.size(); ++i) {
      f.error *= techniques_[setting.space].axes[i][setting.at[i]].error;
      f.ms *= techniques_[setting.space].axes[i][setting.at[i]].ms;
    }
    return f;
  }

  /// The time of the answer where errors are limited.
  double quickest(double error) const {
    const TuneResult result = tune(spaces_, {.error = error}, tunePlan(128, 96, 3, 2),
                                   [&](std::span<const TuneSetting> settings, const TuneEffort&) {
                                     std::vector<TuneFigures> figures;
                                     for (const TuneSetting& s : settings) figures.push_back(truth(s));
                                     return figures;
                                   });
    return result.answers.empty() ? std::numeric_limits<double>::infinity()
                                  : truth(result.answers.front()).ms;
  }

 private:
  std::vector<Technique> techniques_;
  std::vector<TuneSpace> spaces_;
};

// As in chess: one step is slow and alone keeps the limit, another one is quick, and only together are they
// the answer, while quick settings abound that miss the limit.
TEST(Tune, CombinesASlowStepThatKeepsTheLimitWithAQuickOne) {
  const std::vector<Factors::Change> size{{0.41, 0.99}, {1, 1}, {3.3, 1}}, views{{1, 1}, {3, 0.746}};
  const Factors chess(
      {{{90, 0.1387}, {{{0.95, 1.09}, {1, 1}, {1.2, 0.946}}, {{0.95, 1.01}, {1, 1}, {1.05, 1}}, size, views}},
       {{58, 0.1495}, {{{0.93, 1.004}, {1, 1}, {1.16, 1}}, size, views}},
       {{9, 0.209}, {{{0.79, 1.006}, {1, 1}, {1.95, 1}}}}});
  EXPECT_LT(chess.quickest(0.1057), 1.1 * 90 * 0.41 * 3);
}

// As in frog: another technique keeps the limit and its steps are dear, so that not all steps from the
// defaults are tried at once, and then a better setting than the defaults is known. The answer needs the step
// that was left.
TEST(Tune, StepsFromDefaultsThatAreBeatenAsWell) {
  const std::vector<Factors::Change> size{{0.55, 1.056}, {1, 1}, {1.11, 1.057}};
  const Factors frog({{{12.5, 0.1196}, {size}},
                      {{22.3, 0.0493},
                       {{{0.75, 1.28}, {1, 1}, {1.05, 0.948}},
                        {{0.6, 1.02}, {1, 1}, {0.65, 0.997}},
                        size,
                        {{1, 1}, {4.7, 0.61}}}},
                      {{247.7, 0.0314}, {{{0.53, 1.22}, {1, 1}, {1.9, 0.9}}, size}}});
  EXPECT_LT(frog.quickest(0.0467), 1.1 * 22.3 * 1.05 * 0.65);
}

TEST(Tune, SaysWhatComesNearestWhereNothingKeepsTheLimit) {
  Model model = softShadows(2);
  const auto measured = [&](std::span<const TuneSetting> settings, const TuneEffort& effort) {
    return model.measure(settings, effort);
  };
  const TuneResult result = tune(model.spaces(), {.ms = 1}, tunePlan(640, 480, 10, 5), measured);
  EXPECT_TRUE(result.answers.empty());
  ASSERT_TRUE(result.nearest.has_value());
  EXPECT_LT(model.truth(*result.nearest).ms, 6);
}

TEST(Tune, StepsFirstInTheTechniqueThatKeepsTheLimit) {
  const TuneAxis axis{"t.p", {"1", "2", "4"}, 1};
  const std::vector<TuneSpace> spaces = {{"far", {axis, axis, axis}}, {"near", {axis, axis, axis}}};
  std::vector<std::vector<TuneSetting>> batches;
  const auto measured = [&](std::span<const TuneSetting> settings, const TuneEffort&) {
    std::vector<TuneFigures> figures;
    for (const TuneSetting& s : batches.emplace_back(settings.begin(), settings.end())) {
      const auto steps = static_cast<double>(s.at[0] + s.at[1] + s.at[2]);
      figures.push_back({s.space == 0 ? 1 : 0.1 * std::pow(0.9, steps), 10 + steps, false});
    }
    return figures;
  };
  tune(spaces, {.error = 0.09}, tunePlan(64, 48, 3, 2), measured);
  ASSERT_GT(batches.size(), 1u);
  ASSERT_GE(batches[1].size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(batches[1][i].space, 1u);
}

TEST(Tune, SettingsThatFailAreLeftOut) {
  const std::vector<TuneSpace> spaces = {{"a", {{"a.p", {"1", "2", "4"}, 1}}}, {"b", {}}};
  const auto measured = [](std::span<const TuneSetting> settings, const TuneEffort&) {
    std::vector<TuneFigures> figures;
    for (const TuneSetting& s : settings)
      figures.push_back(s.space == 1        ? TuneFigures{0, 0, true}
                        : s.at.front() == 2 ? TuneFigures{0.1, 9, false}
                                            : TuneFigures{0.2, 5, false});
    return figures;
  };
  const TuneResult result = tune(spaces, {.ms = 10}, tunePlan(64, 48, 10, 5), measured);
  ASSERT_FALSE(result.answers.empty());
  EXPECT_EQ(result.answers.front(), (TuneSetting{0, {2}}));
  EXPECT_EQ(result.looked, 4u);
  const auto failing = [](std::span<const TuneSetting> settings, const TuneEffort&) {
    return std::vector<TuneFigures>(settings.size(), TuneFigures{0, 0, true});
  };
  const TuneResult nothing = tune(spaces, {.error = 1}, tunePlan(64, 48, 10, 5), failing);
  EXPECT_TRUE(nothing.answers.empty());
  EXPECT_FALSE(nothing.nearest.has_value());
}

}  // namespace
}  // namespace limn::bench
