// Terms that a technique is asked for, and parameters that cannot be measured.
#include "core/session/technique_choice.h"

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/question/technique_names.h"

namespace limn::session {
namespace {

constexpr TechniqueInfo kSeveral{.name = "several",
                                 .title = "",
                                 .source = "",
                                 .terms = Term::visibility | Term::indirect | Term::environment,
                                 .parameters = {},
                                 .stress = {}};

TermSet asked(std::string_view text) {
  return askedFor(kSeveral, *namedTechniques(text).at(0).terms);
}

std::string refusedChoice(std::string_view text) {
  try {
    asked(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(AskedFor, IsTheSetOfTheTerms) {
  EXPECT_EQ(asked("several:indirect"), termSet(Term::indirect));
  EXPECT_EQ(asked("several:indirect+visibility"), Term::visibility | Term::indirect);
  EXPECT_EQ(asked("several:indirect+visibility+environment"), kSeveral.terms);
}

TEST(AskedFor, RefusesWhatTheTechniqueDoesNotAnswer) {
  EXPECT_EQ(refusedChoice("several:indrect"),
            "unknown term 'indrect' of technique several (did you mean indirect?); it answers visibility, "
            "environment and indirect");
  EXPECT_EQ(refusedChoice("several:media"),
            "technique several does not answer media; it answers visibility, environment and indirect");
  EXPECT_EQ(refusedChoice("several:final"),
            "technique several does not answer final; it answers visibility, environment and indirect");
}

TEST(AskedFor, RefusesListsThatLackATermOrRepeatOne) {
  const std::string lacks = "lacks a term; several answers visibility, environment and indirect";
  for (const std::string text : {"several:", "several:+", "several:indirect+", "several:+indirect"})
    EXPECT_EQ(refusedChoice(text), "technique '" + text + "' " + lacks);
  EXPECT_EQ(refusedChoice("several:indirect+indirect"),
            "term indirect of technique several is named twice; once is enough");
}

/// A budget of time has another level when frames are timed than in the first one, whose error is measured.
TEST(CheckMeasurable, RefusesWhatFollowsTheClock) {
  static constexpr Parameter kParameters[] = {
      integer("lights", 25, {1, 64}, "lights", "Lights"),
      real("frame_time", 0, {0, 100}, "ms", "Time that a frame may take").byClock()};
  const TechniqueInfo info{.name = "budgeted",
                           .title = "",
                           .source = "",
                           .terms = termSet(Term::environment),
                           .parameters = kParameters,
                           .stress = {}};
  TechniquePlugin plugin{};
  plugin.info = &info;
  std::vector<render::TechniqueUse> uses;
  uses.push_back({&plugin, ParameterValues("budgeted", kParameters)});
  uses[0].parameters.set("lights", "8");
  EXPECT_NO_THROW(checkMeasurable(uses));
  uses[0].parameters.set("frame_time", "40");
  try {
    checkMeasurable(uses);
    ADD_FAILURE() << "nothing was refused";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("budgeted.frame_time=40: "));
    EXPECT_THAT(error.what(), testing::EndsWith("benches accept 0 alone"));
  }
}

}  // namespace
}  // namespace limn::session
