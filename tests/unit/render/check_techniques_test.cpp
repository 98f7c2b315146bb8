// Which techniques go together, and which terms they can show, for every row of the table of terms.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <span>

#include "core/base/error.h"
#include "core/render/renderer.h"

namespace limn::render {
namespace {

/// A technique that answers these terms and can do nothing.
struct Claimant {
  TechniqueInfo info;
  TechniquePlugin plugin{};

  Claimant(const char* name, TermSet terms, std::span<const Parameter> parameters = {})
      : info{
            .name = name, .title = "", .source = "", .terms = terms, .parameters = parameters, .stress = {}} {
    plugin.info = &info;
  }
  Claimant(const Claimant&) = delete;
  Claimant& operator=(const Claimant&) = delete;
  TechniqueUse use() const { return {&plugin, ParameterValues(info.name, info.parameters)}; }
};

/// What is said against a picture of `term` by techniques that answer these sets of terms.
std::string refusal(TermSet first, TermSet second, Term term = Term::final) {
  const Claimant one("one", first), other("other", second);
  try {
    checkTechniques({one.use(), other.use()}, term);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckTechniques, ExclusiveTermsAreRefusedWhereTwoClaimThem) {
  for (const TermInfo& info : kTerms) {
    if (!info.answerable) continue;
    const TermSet terms = termSet(info.term);
    const std::string expected =
        info.exclusive
            ? fmt::format("techniques one and other both answer {}; name one of them", info.exclusive)
            : "";
    EXPECT_EQ(refusal(terms, terms), expected) << info.name;
    EXPECT_EQ(refusal(terms | Term::indirect, terms | Term::media),
              info.exclusive ? expected + ", or other:media" : "")
        << info.name;
    EXPECT_EQ(refusal(terms | Term::indirect, terms), info.exclusive ? expected + ", or one:indirect" : "")
        << info.name;
  }
}

TEST(CheckTechniques, VisibilityAndDirectAreOneClaim) {
  const std::string both = "techniques one and other both answer direct light; name one of them";
  EXPECT_EQ(refusal(termSet(Term::visibility), termSet(Term::direct)), both);
  EXPECT_EQ(refusal(termSet(Term::direct), termSet(Term::visibility)), both);
  EXPECT_EQ(refusal(Term::visibility | Term::direct, termSet(Term::indirect)), "");
  EXPECT_EQ(refusal(termSet(Term::direct), termSet(Term::environment)), "");
}

TEST(CheckTechniques, ReliefIsRefusedBesideDirectLight) {
  EXPECT_EQ(
      refusal(termSet(Term::relief), termSet(Term::direct)),
      "technique one answers relief, for which the direct light of other has no place; name one of them");
  EXPECT_EQ(
      refusal(Term::visibility | Term::direct, termSet(Term::relief)),
      "technique other answers relief, for which the direct light of one has no place; name one of them, or "
      "one:visibility");
  EXPECT_EQ(refusal(termSet(Term::relief), termSet(Term::visibility)), "");
  EXPECT_EQ(refusal(Term::relief | Term::direct, termSet(Term::indirect)), "");
}

TEST(CheckTechniques, OnlyTermsThatAreAskedForAreClaims) {
  const Claimant one("one", Term::visibility | Term::indirect),
      other("other", Term::visibility | Term::media);
  TechniqueUse part = one.use();
  part.terms = termSet(Term::indirect);
  EXPECT_THROW(checkTechniques({one.use(), other.use()}, Term::final), UsageError);
  EXPECT_NO_THROW(checkTechniques({part, other.use()}, Term::final));
  EXPECT_NO_THROW(checkTechniques({part, other.use()}, Term::visibility));
  try {
    checkTechniques({part}, Term::visibility);
    ADD_FAILURE() << "there is no such picture";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "technique one:indirect is not asked for visibility, which it answers, too");
  }
  part.terms = termSet(Term::visibility);
  EXPECT_EQ(bouncesOf(Term::final, {one.use()}), 1);
  EXPECT_EQ(bouncesOf(Term::final, {part}), 0);
}

TEST(NameOf, SaysTheTermsWhereTheyAreNotAll) {
  const Claimant one("one", Term::visibility | Term::indirect | Term::media),
      other("other", termSet(Term::media));
  TechniqueUse use = one.use();
  EXPECT_EQ(nameOf(use), "one");
  use.terms = one.info.terms;
  EXPECT_EQ(nameOf(use), "one");
  use.terms = Term::media | Term::indirect;
  EXPECT_EQ(nameOf(use), "one:indirect+media");
  EXPECT_EQ(namesOf({other.use(), use}), "other,one:indirect+media");
  EXPECT_EQ(namesOf({other.use(), use}, ", "), "other, one:indirect+media");
  EXPECT_EQ(namesOf({}), "");
}

TEST(CheckTechniques, PicturesNeedAnAnswerUnlessTheTableSaysOtherwise) {
  for (const TermInfo& info : kTerms) {
    const TermSet others = kAnswerableTerms & ~exclusiveWith(termSet(info.term)) & ~termSet(info.term);
    const std::string without = refusal(others, 0, info.term);
    const std::string with = refusal(kAnswerableTerms, 0, info.term);
    switch (info.picture) {
      case TermPicture::none:
        EXPECT_THAT(without, testing::HasSubstr("no picture shows the term")) << info.name;
        EXPECT_EQ(with, without) << info.name;
        break;
      case TermPicture::answered:
        EXPECT_EQ(without,
                  fmt::format("no technique given answers the term {}; limn list says which do", info.name));
        EXPECT_EQ(with, "") << info.name;
        break;
      case TermPicture::always:
        EXPECT_EQ(without, "") << info.name;
        EXPECT_EQ(with, "") << info.name;
        break;
    }
  }
}

TEST(BouncesOf, FollowsTheParameterOfWhatAnswersIndirect) {
  static constexpr Parameter kBounces[] = {integer("bounces", 2, {1, 16}, "bounces", "Of light")};
  const Claimant once("once", termSet(Term::indirect)),
      shadows("shadows", termSet(Term::visibility), kBounces),
      several("several", Term::visibility | Term::indirect, kBounces);
  TechniqueUse more = several.use();
  more.parameters.set("bounces", "3");
  for (const Term term : {Term::indirect, Term::final, Term::subsurface, Term::specular}) {
    EXPECT_EQ(bouncesOf(term, {once.use()}), 1);
    EXPECT_EQ(bouncesOf(term, {several.use()}), 2);
    EXPECT_EQ(bouncesOf(term, {shadows.use(), more}), 3);
  }
  for (const Term term : {Term::final, Term::subsurface, Term::specular})
    EXPECT_EQ(bouncesOf(term, {shadows.use()}), 0) << "it has no indirect light to count";
  EXPECT_EQ(bouncesOf(Term::indirect, {}), 1) << "there is no such picture without a bounce";
  EXPECT_EQ(bouncesOf(Term::visibility, {several.use()}), 0);
}

TEST(HistoryOf, IsOfTechniquesThatThePictureAsks) {
  static constexpr Parameter kHistory[] = {integer("history", 4, {1, 16}, "frames", "Averaged")};
  const Claimant bounces("bounces", termSet(Term::indirect), kHistory),
      shadows("shadows", termSet(Term::visibility), kHistory),
      both("both", Term::visibility | Term::indirect, kHistory), plain("plain", termSet(Term::indirect));
  for (const Term term : {Term::final, Term::indirect, Term::subsurface, Term::specular}) {
    EXPECT_EQ(historyOf(term, {bounces.use(), plain.use()}), 4) << limn::name(term);
    EXPECT_EQ(historyOf(term, {plain.use()}), 1) << limn::name(term);
  }
  for (const Term term : {Term::direct, Term::visibility, Term::relief, Term::caustic, Term::media})
    EXPECT_EQ(historyOf(term, {bounces.use()}), 1) << limn::name(term);
  for (const Term term : {Term::final, Term::direct, Term::visibility, Term::subsurface, Term::specular})
    EXPECT_EQ(historyOf(term, {shadows.use()}), 4) << limn::name(term);
  for (const Term term : {Term::indirect, Term::relief, Term::caustic, Term::media})
    EXPECT_EQ(historyOf(term, {shadows.use()}), 1) << limn::name(term);
  TechniqueUse part = both.use();
  part.terms = termSet(Term::visibility);
  EXPECT_EQ(historyOf(Term::indirect, {both.use()}), 4);
  EXPECT_EQ(historyOf(Term::indirect, {part}), 1) << "it is not asked for it";
  EXPECT_EQ(historyOf(Term::final, {}), 1);
}

}  // namespace
}  // namespace limn::render
