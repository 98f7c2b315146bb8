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

/// What is chosen, and how many devices are tried for it.
struct Choice {
  std::optional<std::string> made;
  int tried = 0;
};

Choice choose(const std::vector<Outcome>& outcomes) {
  Choice choice;
  choice.made = firstThatWorks(outcomes, [&](const Outcome& outcome) -> std::optional<std::string> {
    ++choice.tried;
    if (outcome.kind == fails) throw Error(outcome.text);
    if (outcome.kind == absent) return {};
    return outcome.text;
  });
  return choice;
}

TEST(FirstThatWorks, TriesNothingBehindTheFirst) {
  const Choice choice = choose({{works, "a GPU"}, {works, "another"}});
  EXPECT_EQ(choice.made, "a GPU");
  EXPECT_EQ(choice.tried, 1);
}

TEST(FirstThatWorks, GoesOnWhereADeviceIsNotThereOrDoesNotSuffice) {
  EXPECT_EQ(choose({{absent}, {fails, "OpenGL 3.3"}, {absent}, {works, "llvmpipe"}}).made, "llvmpipe");
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
