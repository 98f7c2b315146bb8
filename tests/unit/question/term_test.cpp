// The table of terms, and what is made of it. A row more is parsed, offered, listed and documented, or a test
// here says what is missing; that claims are refused is tested in tests/unit/render.
#include "core/question/term.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <bit>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/suite.h"
#include "core/question/question_fields.h"
#include "tests/support/paths.h"

namespace limn {
namespace {

using testing::HasSubstr;

constexpr TermSet kAll = termsWhere([](const TermInfo&) { return true; });

std::string document(const char* name) {
  return readTextFile(std::string(test::kSourceDir) + "/docs/" + name, 1 << 24);
}

/// The complaint about a text that is no term, or nothing.
template <class Read>
std::string complaint(Read read) {
  try {
    read();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Terms, RowsAreCompleteAndDifferent) {
  std::set<std::string> names, phrases;
  std::set<int> hashed;
  TermSet seen = 0;
  for (const TermInfo& info : kTerms) {
    EXPECT_TRUE(std::has_single_bit(termSet(info.term))) << info.name;
    EXPECT_FALSE(contains(seen, info.term)) << info.name;
    seen = seen | info.term;
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_TRUE(phrases.insert(info.help).second) << info.name;
    for (const char* text : {info.name, info.paths, info.help, info.unanswered})
      EXPECT_STRNE(text, "") << info.name;
    if (info.picture == TermPicture::none)
      EXPECT_EQ(info.hashed, -1) << info.name << " has no reference";
    else
      EXPECT_TRUE(info.hashed >= 0 && hashed.insert(info.hashed).second) << info.name;
    EXPECT_TRUE(info.answerable || !info.exclusive) << info.name;
    EXPECT_TRUE(info.answerable || info.picture == TermPicture::always) << info.name << " is of no use";
  }
  EXPECT_TRUE(std::has_single_bit(seen + 1)) << "a term without a row: bits " << seen;
  EXPECT_EQ(seen, kAll);
}

TEST(Terms, NamesAndRowsBelongToEachOther) {
  for (const TermInfo& info : kTerms) {
    EXPECT_EQ(termInfo(info.term).term, info.term);
    EXPECT_STREQ(name(info.term), info.name);
    EXPECT_THAT(termNames(termSet(info.term)), testing::ElementsAre(info.name));
  }
  EXPECT_EQ(termNames(kAll).size(), std::size(kTerms));
  EXPECT_THROW(termInfo(static_cast<Term>(0)), std::logic_error);
  EXPECT_THROW(termInfo(static_cast<Term>(Term::direct | Term::indirect)), std::logic_error);
}

TEST(Terms, AreParsedWhereAPictureShowsThem) {
  for (const TermInfo& info : kTerms)
    if (info.picture == TermPicture::none)
      EXPECT_THROW(parseTerm(info.name), UsageError) << info.name;
    else
      EXPECT_EQ(parseTerm(info.name), info.term);
  EXPECT_THROW(parseTerm(""), UsageError);
}

TEST(Terms, UnknownOnesAreRefusedInOneWording) {
  const std::string message = complaint([] { parseTerm("indirekt"); });
  EXPECT_THAT(message, HasSubstr("unknown term 'indirekt' (did you mean"));
  EXPECT_THAT(message,
              testing::EndsWith(fmt::format("; known are {}", fmt::join(termNames(kPicturedTerms), ", "))));
  const auto suite = [](const std::string& own, const std::string& scenes) {
    bench::parseSuite("name = \"s\"\nsizes = \"8x8\"\n" + own +
                          "[[techniques]]\ntechnique = \"pcss\"\n[[scenes]]\nscene = \"balls\"\n" + scenes,
                      "s.toml");
  };
  const std::string line = "term = \"indirekt\"\n";
  EXPECT_EQ(complaint([&] { suite(line, ""); }), "s.toml:3:8: " + message);
  EXPECT_EQ(complaint([&] { suite("", line); }), "s.toml:7:8: " + message);
  EXPECT_EQ(complaint([&] { suite("", ""); }), "");
}

TEST(Terms, AreTheChoicesOfAQuestion) {
  const QuestionField& field = questionField("term");
  const std::vector<std::string> choices(field.choices.begin(), field.choices.end());
  EXPECT_EQ(choices, termNames(kPicturedTerms));
  ASSERT_EQ(field.choiceDocs.size(), choices.size());
  for (size_t i = 0; i < choices.size(); ++i)
    EXPECT_STREQ(field.choiceDocs[i], termInfo(parseTerm(choices[i])).help);
}

TEST(Terms, OfTheMediumAreWhereNoSurfaceIs) {
  for (const TermInfo& info : kTerms) EXPECT_EQ(hasBackground(info.name), info.term == Term::media);
  EXPECT_FALSE(hasBackground("indirekt"));
}

/// Visibility and direct light are two ways to answer the same.
TEST(Terms, ExcludeEachOtherWhereTheTableSaysSo) {
  EXPECT_EQ(exclusiveWith(termSet(Term::visibility)), Term::visibility | Term::direct);
  EXPECT_EQ(exclusiveWith(termSet(Term::direct)), Term::visibility | Term::direct);
  EXPECT_EQ(exclusiveWith(Term::direct | Term::environment),
            Term::visibility | Term::direct | Term::environment);
  for (const Term term : {Term::environment, Term::specular, Term::surface, Term::relief, Term::subsurface})
    EXPECT_EQ(exclusiveWith(termSet(term)), termSet(term));
  for (const Term term : {Term::indirect, Term::caustic, Term::media})
    EXPECT_EQ(exclusiveWith(termSet(term)), 0u);
}

/// Direct light is answered with its factors: only V is answered beside W.
TEST(Terms, ReliefIsRefusedBesideDirectLight) {
  EXPECT_EQ(refusedBeside(termSet(Term::relief)), Term::relief | Term::direct);
  EXPECT_EQ(refusedBeside(termSet(Term::direct)), Term::visibility | Term::direct | Term::relief);
  EXPECT_EQ(refusedBeside(termSet(Term::visibility)), exclusiveWith(termSet(Term::visibility)));
}

/// Cached references are found by these numbers.
TEST(Terms, NumbersInHashesStay) {
  const std::pair<Term, int> numbers[] = {{Term::direct, 0},   {Term::visibility, 1}, {Term::final, 2},
                                          {Term::indirect, 3}, {Term::caustic, 4},    {Term::media, 5},
                                          {Term::specular, 6}, {Term::relief, 7},     {Term::subsurface, 8}};
  for (const auto& [term, number] : numbers) EXPECT_EQ(termInfo(term).hashed, number) << name(term);
}

TEST(Terms, DocumentsHaveTheTable) {
  std::string rows = "| term | what | light paths | unanswered |\n| --- | --- | --- | --- |\n";
  for (const TermInfo& info : kTerms)
    rows += fmt::format("| `{}` | {} | {} | {} |\n", info.name, info.help, info.paths, info.unanswered);
  EXPECT_THAT(document("architecture.md"), HasSubstr("\n" + rows + "\n"));
  const std::string row = fmt::format("\n| `term` | `{}` |", fmt::join(termNames(kPicturedTerms), "`, `"));
  EXPECT_THAT(document("bench.md"), HasSubstr(row));
}

}  // namespace
}  // namespace limn
