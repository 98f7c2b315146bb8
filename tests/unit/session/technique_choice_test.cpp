// Terms that a technique is asked for.
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

}  // namespace
}  // namespace limn::session
