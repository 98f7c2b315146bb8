// Undo and redo.
#include "apps/view/edit_history.h"

#include <gtest/gtest.h>

namespace limn::app {
namespace {

Edit withTime(double time) {
  Edit edit;
  edit.state.scene.time = time;
  return edit;
}

TEST(EditHistory, GoesBackAndForth) {
  EditHistory history;
  EXPECT_EQ(history.undo(), nullptr) << "nothing is known yet";
  history.restart(withTime(0));
  for (const double time : {1., 2., 3.}) history.note(withTime(time));
  EXPECT_EQ(history.redo(), nullptr);
  EXPECT_EQ(history.undo()->state.scene.time, 2);
  EXPECT_EQ(history.undo()->state.scene.time, 1);
  EXPECT_EQ(history.redo()->state.scene.time, 2);
  history.note(withTime(2));
  EXPECT_EQ(history.redo()->state.scene.time, 3) << "what is there already adds nothing";
}

TEST(EditHistory, WhatWasUndoneIsForgottenWithTheNextChange) {
  EditHistory history;
  history.restart(withTime(0));
  history.note(withTime(1));
  history.undo();
  history.note(withTime(5));
  EXPECT_EQ(history.redo(), nullptr);
  EXPECT_EQ(history.undo()->state.scene.time, 0);
  EXPECT_EQ(history.undo(), nullptr);
}

/// Of a scene that was read again from elsewhere: a drag after undo starts where the camera is.
TEST(EditHistory, CountsItsOrbitsFromTheOriginThatIsShown) {
  EditHistory history;
  history.restart(withTime(0));
  history.note(withTime(1));
  const glm::vec3 eye = Orbit().eye();
  history.recount({0, 0, 0}, {8, 0, -2});
  EXPECT_EQ(history.undo()->orbit.eye(), eye + glm::vec3(-8, 0, 2));
  EXPECT_EQ(history.redo()->orbit.eye(), eye + glm::vec3(-8, 0, 2));
}

/// Its title and sentence are those of the techniques that come back.
TEST(EditHistory, KnowsTheStepOfTheGuide) {
  EditHistory history;
  history.restart(withTime(0));
  Edit next = withTime(0);
  next.step = 1;
  history.note(next);
  const Edit* before = history.undo();
  ASSERT_NE(before, nullptr);
  EXPECT_EQ(before->step, 0u);
  EXPECT_EQ(history.redo()->step, 1u);
}

Edit withEnvironment(const char* environment, double time = 0) {
  Edit edit = withTime(time);
  edit.state.scene.environment = environment;
  return edit;
}

/// As if what could not be opened had never been chosen, and both ways go on beyond it.
TEST(EditHistory, ForgetsWhatCannotBeOpened) {
  EditHistory history;
  history.restart(withEnvironment("a"));
  for (const char* environment : {"gone", "b"}) history.note(withEnvironment(environment));
  history.note(withEnvironment("gone", 1));
  history.note(withEnvironment("c"));
  EXPECT_EQ(history.undo()->state.scene.environment, "gone");
  history.forget(withEnvironment("gone", 5).state.scene);
  EXPECT_EQ(history.redo()->state.scene.environment, "c") << "from b";
  EXPECT_EQ(history.undo()->state.scene.environment, "b");
  EXPECT_EQ(history.undo()->state.scene.environment, "a");
  EXPECT_EQ(history.undo(), nullptr);
}

TEST(EditHistory, MayForgetTheFirstAndAll) {
  EditHistory history;
  history.restart(withEnvironment("gone"));
  history.note(withEnvironment("a"));
  history.undo();
  history.forget(withEnvironment("gone").state.scene);
  history.note(withEnvironment("a"));
  EXPECT_EQ(history.undo(), nullptr) << "a is the first now";
  history.forget(withEnvironment("a").state.scene);
  EXPECT_EQ(history.undo(), nullptr);
  EXPECT_EQ(history.redo(), nullptr);
  history.note(withEnvironment("b"));
  history.note(withEnvironment("c"));
  EXPECT_EQ(history.undo()->state.scene.environment, "b");
}

TEST(EditHistory, TheSizeOfTheWindowIsNoChange) {
  EditHistory history;
  history.restart(withTime(0));
  Edit larger = withTime(0);
  larger.state.scene.width = 999;
  history.note(larger);
  EXPECT_EQ(history.undo(), nullptr);
}

TEST(EditHistory, ToneAndExposureAreChanges) {
  Edit tone = withTime(0), automatic = withTime(0);
  tone.state.tone.curve = ToneCurve::agx;
  automatic.state.automaticExposure = true;
  EXPECT_FALSE(same(withTime(0), tone));
  EXPECT_FALSE(same(withTime(0), automatic));
}

TEST(EditHistory, ForgetsTheOldestOfVeryMany) {
  EditHistory history;
  history.restart(withTime(0));
  for (int i = 1; i <= 2000; ++i) history.note(withTime(i));
  int undone = 0;
  while (history.undo() != nullptr) ++undone;
  EXPECT_EQ(undone, 499);
}

}  // namespace
}  // namespace limn::app
