// Which of several devices a context is made on where none was asked for.
#include "core/context/private/first_that_works.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace limn {
namespace {

/// What comes of a device: it works, is not there, or says why it does not suffice.
struct Outcome {
  enum class Kind { works, absent, fails } kind;
  std::string text = {};
};
using enum Outcome::Kind;

/// What is chosen, how many devices are tried for it, and what is said of those that are passed over.
struct Choice {
  std::optional<std::string> made;
  int tried = 0;
  std::vector<std::string> passedOver = {};
};

Choice choose(const std::vector<Outcome>& outcomes) {
  Choice choice;
  choice.made = firstThatWorks(
      outcomes,
      [&](const Outcome& outcome) -> std::optional<std::string> {
        ++choice.tried;
        if (outcome.kind == fails) throw Error(outcome.text);
        if (outcome.kind == absent) return {};
        return outcome.text;
      },
      [&](const Outcome&, const std::string& why) { choice.passedOver.push_back(why); });
  return choice;
}

TEST(FirstThatWorks, TriesNothingBehindTheFirst) {
  const Choice choice = choose({{works, "a GPU"}, {works, "another"}});
  EXPECT_EQ(choice.made, "a GPU");
  EXPECT_EQ(choice.tried, 1);
  EXPECT_TRUE(choice.passedOver.empty());
}

TEST(FirstThatWorks, GoesOnWhereADeviceIsNotThereOrDoesNotSuffice) {
  const Choice choice = choose({{absent}, {fails, "OpenGL 3.3"}, {absent}, {works, "llvmpipe"}, {absent}});
  EXPECT_EQ(choice.made, "llvmpipe");
  EXPECT_EQ(choice.passedOver, (std::vector<std::string>{"", "OpenGL 3.3", ""}));
}

TEST(FirstThatWorks, SaysOfNoneWhatTheFirstSaid) {
  try {
    choose({{absent}, {fails, "OpenGL 3.3"}, {fails, "no configuration"}, {absent}});
    FAIL() << "something was made";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "OpenGL 3.3");
  }
}

TEST(FirstThatWorks, MakesNothingWhereNothingIsThere) {
  EXPECT_EQ(choose({}).made, std::nullopt);
  EXPECT_EQ(choose({{absent}, {absent}}).made, std::nullopt);
}

}  // namespace
}  // namespace limn
