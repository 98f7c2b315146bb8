// Budgets of frame time: levels are found, kept, and left slowly.
#include "core/technique/frame_budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/scene/scene.h"

namespace limn {
namespace {

const std::vector<double> kWork{1, 2, 4, 8, 16};

/// Draws frames whose time is that of the level; returns the level after them.
double draw(FrameBudget& budget, int frames, double millisecondsPerWork, double* largestStep = nullptr) {
  for (int i = 0; i < frames; ++i) {
    const double before = budget.position();
    budget.addFrame(millisecondsPerWork * std::exp2(before));
    if (largestStep) *largestStep = std::max(*largestStep, std::abs(budget.position() - before));
    EXPECT_GE(budget.dearest(), budget.position());
    EXPECT_LT(budget.dearest(), 5);
  }
  return budget.position();
}

TEST(FrameBudget, StartsAtTheDearestLevelAndStaysWhereThatIsQuick) {
  FrameBudget budget(20, kWork);
  EXPECT_EQ(budget.position(), 4);
  EXPECT_EQ(draw(budget, 100, 1), 4);
}

TEST(FrameBudget, FindsTheLevelThatKeepsTheTime) {
  FrameBudget budget(5, kWork);
  double step = 0;
  EXPECT_EQ(draw(budget, 60, 1, &step), 2);
  EXPECT_LT(step, 0.2);
  EXPECT_EQ(draw(budget, 1000, 1), 2) << "it does not swing";
}

TEST(FrameBudget, GoesUpWhereThereIsTime) {
  FrameBudget budget(5, kWork);
  draw(budget, 60, 4);
  EXPECT_EQ(budget.target(), 0);
  EXPECT_EQ(draw(budget, 1000, 0.5), 3);
}

TEST(FrameBudget, KeepsTheCheapestLevelWhereNoneIsQuickEnough) {
  FrameBudget budget(0.1, kWork);
  EXPECT_EQ(draw(budget, 300, 1), 0);
  FrameBudget single(0.1, {1});
  single.addFrame(1);
  EXPECT_EQ(single.position(), 0);
}

TEST(FrameBudget, SingleSlowFramesChangeNothing) {
  FrameBudget budget(20, kWork);
  for (int i = 0; i < 200; ++i) budget.addFrame(i % 5 == 0 ? 1000 : 10);
  EXPECT_EQ(budget.position(), 4);
}

/// Draws frames of which `constant` ms are the same at all levels, give or take a share of the whole; returns
/// the level after them.
double drawMostlyConstant(FrameBudget& budget, int frames, double constant, double perWork,
                          double noise = 0) {
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> share(1 - noise, 1 + noise);
  for (int i = 0; i < frames; ++i)
    budget.addFrame((constant + perWork * std::exp2(budget.position())) * share(random));
  return budget.position();
}

/// In proportion to the work the second level would take 28.4 ms; it takes 14.4.
TEST(FrameBudget, RisesAfterAStallWhereMostOfAFrameIsTheSameAtAllLevels) {
  FrameBudget budget(20, kWork);
  EXPECT_EQ(drawMostlyConstant(budget, 50, 14, 0.2), 4);
  for (int i = 0; i < 100; ++i) budget.addFrame(100);
  EXPECT_EQ(budget.position(), 0);
  EXPECT_EQ(drawMostlyConstant(budget, 500, 14, 0.2), 4);
}

/// Levels above are known from the times before, in proportion to what a frame takes now.
TEST(FrameBudget, RisesWhereTheSceneBecomesCheaperAtAllLevels) {
  FrameBudget budget(20, kWork);
  EXPECT_EQ(drawMostlyConstant(budget, 300, 14, 2), 2);
  EXPECT_EQ(drawMostlyConstant(budget, 1000, 7, 1), 3) << "15 ms; the dearest level takes 23";
  EXPECT_EQ(drawMostlyConstant(budget, 1000, 5, 0.5), 4);
}

TEST(FrameBudget, NoiseDoesNotMakeItSwing) {
  FrameBudget budget(20, kWork);
  EXPECT_EQ(drawMostlyConstant(budget, 60, 10, 1, 0.08), 3);
  for (int i = 0; i < 300; ++i) EXPECT_EQ(drawMostlyConstant(budget, 10, 10, 1, 0.08), 3);
}

/// Draws frames that take longer than any budget of `technique`, each of which ends in that way.
template <class End>
const FrameBudget& budgetAfter(FrameServices& services, std::string_view technique, const End& end) {
  frame::FrameGraph graph;
  const scene::Pose pose;
  const FrameBudget& budget = services.get<FrameBudgetService>().request(technique, 1e-12, kWork);
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_FALSE(services.update(graph, pose));
    end();
  }
  return budget;
}

TEST(FrameBudgetService, FramesThatAreGivenUpHaveNoTime) {
  FrameServices services;
  services.add<FrameBudgetService>();
  EXPECT_EQ(budgetAfter(services, "waits for nothing", [] {}).target(), 0);
  EXPECT_EQ(budgetAfter(services, "waits for its frames", [&] { services.waited(); }).target(), 0);
  EXPECT_EQ(budgetAfter(services, "gives up", [&] { services.givenUp(); }).target(), 4);
  services.waited();  // of a frame that was given up
  EXPECT_EQ(budgetAfter(services, "gives up", [&] { services.givenUp(); }).target(), 4);
}

/// As in a bench, whose rows take turns: slow frames of one row are not those of the next one's technique.
TEST(FrameBudgetService, FramesOfGraphsThatDidNotRequestItDoNotCount) {
  FrameServices services;
  auto& budgets = services.add<FrameBudgetService>();
  const scene::Pose pose;
  const auto draw = [&](std::string_view technique) {
    frame::FrameGraph graph;
    {
      const auto building = services.begin(graph, {}, pose);
      budgets.request(technique, 1e-12, kWork);
    }
    for (int frame = 0; frame < 20; ++frame) services.update(graph, pose);
    return budgets.request(technique, 1e-12, kWork).target();
  };
  const FrameBudget& other = budgets.request("another row's", 1e-12, kWork);
  EXPECT_EQ(draw("this row's"), 0);
  EXPECT_EQ(other.target(), 4);
  EXPECT_EQ(draw("another row's"), 0) << "it goes on where it was";
}

}  // namespace
}  // namespace limn
