#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "core/bench/ratio.h"
#include "core/bench/regression.h"

namespace limn::bench {
namespace {

std::vector<double> normal(double mean, double deviation, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> distribution(mean, deviation);
  std::vector<double> samples;
  for (int i = 0; i < count; ++i) samples.push_back(distribution(random));
  return samples;
}

TEST(RatioOfMedians, IntervalHoldsTheTruthAsOftenAsItSays) {
  int inside = 0;
  constexpr unsigned kTrials = 200;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    const std::vector<double> slow = normal(20, 1, 21, 2 * trial), fast = normal(10, 0.5, 21, 2 * trial + 1);
    const Ratio ratio = ratioOfMedians({slow}, {fast});
    inside += ratio.low <= 2 && 2 <= ratio.high;
    EXPECT_TRUE(ratio.low <= ratio.value && ratio.value <= ratio.high);
  }
  // Percentile intervals of medians are a little wide: between 95 % and all of them, less three standard
  // deviations.
  EXPECT_GE(inside, 0.95 * kTrials - 3 * std::sqrt(0.95 * 0.05 * kTrials));
}

TEST(RatioOfMedians, TurnsTellOfDriftThatFramesDoNotSee) {
  // A machine that is 10 % slower or faster from turn to turn, and 1 % from frame to frame.
  constexpr int kTurns = 4, kFrames = 3;
  const auto drifting = [](double mean, unsigned seed) {
    std::vector<double> samples;
    const std::vector<double> speeds = normal(1, 0.1, kTurns, seed);
    for (int turn = 0; turn < kTurns; ++turn)
      for (double value :
           normal(mean * speeds[static_cast<size_t>(turn)], 0.01 * mean, kFrames, seed + 1000u + turn))
        samples.push_back(value);
    return samples;
  };
  constexpr unsigned kTrials = 200;
  int inside = 0, insideUnaware = 0;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    const std::vector<double> slow = drifting(20, 5000 * trial), fast = drifting(10, 5000 * trial + 2500);
    const Ratio aware = ratioOfMedians({slow, kTurns}, {fast, kTurns}),
                unaware = ratioOfMedians({slow}, {fast});
    inside += aware.low <= 2 && 2 <= aware.high;
    insideUnaware += unaware.low <= 2 && 2 <= unaware.high;
  }
  EXPECT_GE(inside, 0.9 * kTrials);
  EXPECT_LT(insideUnaware, inside);
}

/// Two sides of equal true times on a machine that is 5 % quicker or slower from turn to turn, one frame a
/// turn: the interval holds 1 as often as it says, less three standard deviations of the count.
TEST(RatioOfMedians, FewTurnsWidenTheIntervalByStudentsT) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> ms(0, 0.05);
  constexpr int kTrials = 400;
  for (const int turns : {2, 3}) {
    const auto side = [&] {
      std::vector<double> samples;
      for (int turn = 0; turn < turns; ++turn) samples.push_back(ms(random));
      return samples;
    };
    int inside = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const std::vector<double> slow = side(), fast = side();
      const Ratio ratio = ratioOfMedians({slow, turns}, {fast, turns});
      EXPECT_EQ(ratio.turns, turns);
      inside += ratio.low <= 1 && 1 <= ratio.high;
    }
    EXPECT_GE(inside, 0.95 * kTrials - 3 * std::sqrt(0.95 * 0.05 * kTrials)) << turns;
  }
}

/// The same of one median: its turns alone tell how far it scatters. Resamples of two or three turns end at
/// the least and the greatest of them, of which the distances to the median are widened, those of two turns
/// by w = sqrt(2) 12.7 / 1.96: that holds the truth of a normal distribution in 2 / pi atan(w) = 93.1 % of
/// the cases. Of three turns w is sqrt(3 / 2) 4.30 / 1.96, and 91.7 % of 400 000 triples of normal numbers
/// have 0 within.
TEST(MedianWithInterval, HoldsTheTruthAsOftenAsItSays) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> ms(0, 0.05);
  constexpr int kTrials = 400;
  for (const auto& [turns, share] : {std::pair(2, 0.931), {3, 0.917}, {4, 0.95}}) {
    int inside = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> samples;
      for (int turn = 0; turn < turns; ++turn) samples.push_back(ms(random));
      const Ratio median = medianWithInterval({samples, turns});
      EXPECT_EQ(median.turns, turns);
      EXPECT_TRUE(median.low <= median.value && median.value <= median.high);
      inside += median.low <= 1 && 1 <= median.high;
    }
    EXPECT_GE(inside, share * kTrials - 3 * std::sqrt(share * (1 - share) * kTrials)) << turns;
  }
  const double one[] = {4};
  EXPECT_EQ(medianWithInterval({one}).low, 4);
}

/// Coverage alone would praise intervals that are too wide. Of so few turns 2.5 % of the resamples and more
/// end at the least and the greatest of them, so that the ends are known; the quantiles of Student's
/// distribution are those of its tables.
TEST(RatioOfMedians, IntervalsOfFewTurnsAreAsWideAsTheyHaveToBe) {
  const auto expectEnds = [](const Ratio& ratio, double least, double greatest, double student) {
    const double wider = std::sqrt(ratio.turns / (ratio.turns - 1.0)) * student / 1.959964;
    EXPECT_NEAR(ratio.low, ratio.value * std::pow(least / ratio.value, wider), 1e-5) << ratio.turns;
    EXPECT_NEAR(ratio.high, ratio.value * std::pow(greatest / ratio.value, wider), 1e-5) << ratio.turns;
  };
  const double two[] = {8, 12}, twoOthers[] = {5, 4};
  const double three[] = {12, 8, 10}, threeOthers[] = {4, 6, 5}, four[] = {9, 12, 8, 11};
  expectEnds(ratioOfMedians({two, 2}, {twoOthers, 2}), 8.0 / 5, 12.0 / 4, 4.3026527);  // 2 degrees of freedom
  expectEnds(ratioOfMedians({three, 3}, {threeOthers, 3}), 8.0 / 6, 12.0 / 4, 2.7764451);  // 4
  expectEnds(medianWithInterval({two, 2}), 8, 12, 12.7062047);                             // 1
  expectEnds(medianWithInterval({three, 3}), 8, 12, 4.3026527);                            // 2
  expectEnds(medianWithInterval({four, 4}), 8, 12, 3.1824463);                             // 3
  EXPECT_DOUBLE_EQ(medianWithInterval({four, 4}).value, 10);
}

TEST(RatioOfMedians, TheFewerTurnsOfTwoSidesCount) {
  const double three[] = {4, 5, 6}, one[] = {2};
  EXPECT_EQ(ratioOfMedians({three, 3}, {one}).turns, 1);
  EXPECT_EQ(ratioOfMedians({one, 5}, {three, 3}).turns, 1) << "no turn is without a sample";
}

TEST(RatioOfMedians, OneSampleHasNoInterval) {
  const double four[] = {4}, two[] = {2};
  const Ratio ratio = ratioOfMedians({four}, {two});
  EXPECT_EQ(ratio.value, 2);
  EXPECT_EQ(ratio.low, 2);
  EXPECT_EQ(ratio.high, 2);
}

/// Rows of unknown origin may say that a frame took no time, less than none or for ever. Ratios that are no
/// numbers have no order in which they could be sorted.
TEST(RatioOfMedians, TimesOfAnyKindHaveAFiniteRatio) {
  const std::vector<double> none = {0, 0, 0}, some = {0, 2, 4}, other = {-1, 2, 1e308};
  for (const std::vector<double>* above : {&none, &some, &other})
    for (const std::vector<double>* below : {&none, &some, &other}) {
      const Ratio ratio = ratioOfMedians({*above}, {*below});
      for (const double value : {ratio.value, ratio.low, ratio.high}) EXPECT_TRUE(std::isfinite(value));
      EXPECT_TRUE(ratio.low <= ratio.value && ratio.value <= ratio.high);
    }
  EXPECT_EQ(ratioOfMedians({none}, {none}).value, 1);
}

Row row(const std::string& technique, double rmse, double ms) {
  Row row;
  row.what.scene = "balls";
  row.what.term = "visibility";
  row.what.technique = technique;
  row.key = technique;
  row.error.rmse = rmse;
  row.error.noise_floor = 0.003;
  row.error.pixels = 10000;
  row.cost.frameMs.samples = normal(ms, 0.01 * ms, 9, 7);
  row.cost.frameMs.n = 9;
  return row;
}

TEST(Regression, NothingChangesBetweenEqualResults) {
  const std::vector<Row> rows = {row("a", 0.1, 5), row("b", 0, 1)};
  const Regression same = compareResults(rows, rows);
  EXPECT_FALSE(same.found());
  EXPECT_EQ(toMarkdown(same),
            "2 rows compared: 0 slower, 0 worse, 0 failed, 0 faster, 0 better; 0 only before, 0 only now\n");
}

TEST(Regression, NoiseAndDriftAreNoRegression) {
  const std::vector<Row> before = {row("a", 0.1, 5)}, now = {row("a", 0.10003, 5.2)};
  EXPECT_FALSE(compareResults(before, now).found());
}

TEST(Regression, TimesOfTwoMachinesAreNotCompared) {
  std::vector<Row> before = {row("a", 0.1, 5)}, now = {row("a", 0.1, 10)};
  before[0].cost.machine = "a";
  EXPECT_TRUE(compareResults(before, now).found()) << "an earlier version did not record its machine";
  now[0].cost.machine = "a";
  EXPECT_TRUE(compareResults(before, now).found());
  now[0].cost.machine = "b";
  const Regression regression = compareResults(before, now);
  EXPECT_FALSE(regression.found());
  EXPECT_EQ(toMarkdown(regression),
            "1 rows compared: 0 slower, 0 worse, 0 failed, 0 faster, 0 better; 0 only before, 0 only now; "
            "times of 1 not compared, which two machines measured\n");
  now[0].error.rmse = 0.2;
  EXPECT_TRUE(compareResults(before, now).changes[0].worse) << "errors are";
}

/// Nothing says how far one frame scatters.
TEST(Regression, TimesOfOneFrameAreNotCompared) {
  std::vector<Row> before = {row("a", 0.1, 5)}, now = {row("a", 0.1, 10)};
  EXPECT_TRUE(compareResults(before, now).found());
  now[0].cost.frameMs.samples = {10};
  const Regression regression = compareResults(before, now);
  EXPECT_FALSE(regression.found());
  EXPECT_EQ(toMarkdown(regression),
            "1 rows compared: 0 slower, 0 worse, 0 failed, 0 faster, 0 better; 0 only before, 0 only now; "
            "times of 1 not compared, of which one frame was timed\n");
  EXPECT_FALSE(compareResults(now, before).changes[0].faster);
  now[0].error.rmse = 0.2;
  EXPECT_TRUE(compareResults(before, now).changes[0].worse) << "errors are";
}

TEST(Regression, ScenesThatHaveChangedAreNamed) {
  std::vector<Row> before = {row("a", 0.1, 5), row("b", 0.1, 5)}, now = {row("a", 0.2, 5), row("b", 0.1, 5)};
  for (Row* known : {&before[0], &before[1], &now[1]}) known->provenance.scene = "files";
  EXPECT_EQ(toMarkdown(compareResults(before, now)).find("changed"), std::string::npos) << "not recorded";
  now[0].provenance.scene = "edited";
  const std::string text = toMarkdown(compareResults(before, now));
  EXPECT_NE(text.find("; the scenes of 1 have changed in between\n"), std::string::npos) << text;
  EXPECT_NE(text.find("| worse, the scene has changed |"), std::string::npos) << text;
}

TEST(Regression, SlowerAndWorseAreFound) {
  const std::vector<Row> before = {row("slower", 0.1, 5), row("worse", 0.1, 5), row("better", 0.1, 5)};
  const std::vector<Row> now = {row("slower", 0.1, 6), row("worse", 0.103, 5), row("better", 0.09, 4)};
  const Regression regression = compareResults(before, now);
  ASSERT_EQ(regression.changes.size(), 3u);
  EXPECT_TRUE(regression.found());
  EXPECT_TRUE(regression.changes[0].slower && !regression.changes[0].worse);
  EXPECT_TRUE(regression.changes[1].worse && !regression.changes[1].slower);
  EXPECT_TRUE(regression.changes[2].better && regression.changes[2].faster);
  EXPECT_NE(toMarkdown(regression).find("| 1.200 (1.1"), std::string::npos) << toMarkdown(regression);
  EXPECT_FALSE(compareResults(std::span(before).last(1), std::span(now).last(1)).found());
}

TEST(Regression, PenumbraDecidesWhereItIsKnown) {
  std::vector<Row> before = {row("a", 0.1, 5)}, now = before;
  before[0].penumbra = before[0].error;
  now[0].penumbra = now[0].error;
  now[0].penumbra->rmse = 0.2;
  EXPECT_TRUE(compareResults(before, now).changes[0].worse);
}

/// A row of an earlier version knows the error of the whole picture alone.
TEST(Regression, PenumbraStandsBesideNoWholePicture) {
  std::vector<Row> before = {row("a", 0.1, 5)}, now = before;
  now[0].penumbra = now[0].error;
  now[0].penumbra->rmse = 0.4;
  const Change change = compareResults(before, now).changes.at(0);
  EXPECT_FALSE(change.worse);
  EXPECT_EQ(change.error, 0.1);
  std::swap(before, now);
  EXPECT_FALSE(compareResults(before, now).changes[0].better);
}

/// In dark pictures a few pixels hold the noise, so that the errors against two references may differ by more
/// than noise that is spread evenly would explain.
TEST(Regression, NoiseOfAnotherReferenceIsNotWorse) {
  std::vector<Row> before = {row("a", 0.001, 5)}, now = {row("a", 0.0025, 5)};
  before[0].referenceFile = now[0].referenceFile = "references/a.exr";
  EXPECT_TRUE(compareResults(before, now).changes.at(0).worse) << "the reference is the same";
  EXPECT_EQ(toMarkdown(compareResults(before, now)).find("reference"), std::string::npos);
  now[0].referenceFile = "references/b.exr";
  EXPECT_FALSE(compareResults(before, now).found());
  EXPECT_NE(toMarkdown(compareResults(before, now)).find("; the references of 1 have changed in between\n"),
            std::string::npos);
  EXPECT_FALSE(compareResults(now, before).changes[0].better);
  now[0].error.rmse = 0.0035;  // above the floor
  EXPECT_NE(toMarkdown(compareResults(before, now)).find("| worse, the reference has changed |"),
            std::string::npos);
  EXPECT_TRUE(compareResults(now, before).changes[0].better);
}

TEST(Regression, FailuresCountAndStrangersDoNot) {
  std::vector<Row> before = {row("a", 0.1, 5), row("gone", 0.1, 5)},
                   now = {row("a", 0.1, 5), row("new", 0.1, 5)};
  now[0].failure = "lost | context";
  const Regression regression = compareResults(before, now);
  EXPECT_TRUE(regression.found());
  EXPECT_EQ(regression.onlyBefore, 1u);
  EXPECT_EQ(regression.onlyNow, 1u);
  EXPECT_NE(toMarkdown(regression).find("failed: lost \\| context"), std::string::npos)
      << toMarkdown(regression);
}

}  // namespace
}  // namespace limn::bench
