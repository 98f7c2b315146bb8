// Budgets of frame time: levels are found, kept, and left slowly.
#include "core/technique/frame_budget.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace limn
