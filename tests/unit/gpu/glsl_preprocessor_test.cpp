#include "core/gpu/private/glsl_preprocessor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace limn::gpu {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

using Files = std::map<std::string, std::string>;

ExpandedSource expand(const Files& files, const std::map<std::string, std::string>& defines = {},
                      const std::string& entry = "main.comp.glsl") {
  return expandGlsl(entry, defines, [&](const std::string& path) -> std::optional<std::string> {
    const auto found = files.find(path);
    if (found == files.end()) return std::nullopt;
    return found->second;
  });
}

std::string errorOf(const Files& files, const std::map<std::string, std::string>& defines = {}) {
  try {
    expand(files, defines);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(GlslPreprocessor, startsWithVersionAndDefines) {
  EXPECT_EQ(expand({{"main.comp.glsl", "void main() {}\n"}}, {{"LIMN_TAPS", "16"}, {"LIMN_A", ""}}).text,
            "#version 450 core\n#define LIMN_A \n#define LIMN_TAPS 16\n#line 1 0\nvoid main() {}\n");
}

TEST(GlslPreprocessor, includesBesideTheFileFirstThenFromTheRoot) {
  const Files files = {{"t/main.comp.glsl", "#include \"a.glsl\"\n#include \"glsl/b.glsl\"\n"},
                       {"t/a.glsl", "beside\n"},
                       {"a.glsl", "root\n"},
                       {"glsl/b.glsl", "#include \"c/../d.glsl\"\n"},
                       {"glsl/d.glsl", "normalised\n"}};
  const ExpandedSource source = expand(files, {}, "t/main.comp.glsl");
  EXPECT_THAT(source.text, HasSubstr("beside\n"));
  EXPECT_THAT(source.text, Not(HasSubstr("root\n")));
  EXPECT_THAT(source.text, HasSubstr("normalised\n"));
  EXPECT_THAT(source.files, ElementsAre("t/main.comp.glsl", "t/a.glsl", "glsl/b.glsl", "glsl/d.glsl"));
}

TEST(GlslPreprocessor, includesWhatADefineOfTheProgramNames) {
  const Files files = {{"main.comp.glsl", "#ifdef CHOSEN\n#include CHOSEN\n#endif\n"},
                       {"techniques/t/a.glsl", "chosen\n"}};
  const ExpandedSource source = expand(files, {{"CHOSEN", "techniques/t/a.glsl"}});
  EXPECT_THAT(source.text, HasSubstr("chosen\n"));
  EXPECT_THAT(source.files, ElementsAre("main.comp.glsl", "techniques/t/a.glsl"));
  EXPECT_THAT(expand(files).text, Not(HasSubstr("chosen\n")));
  EXPECT_THAT(errorOf({{"main.comp.glsl", "#include CHOSEN\n"}}),
              HasSubstr("include CHOSEN is not of the form \"path\", nor a define of the program"));
}

TEST(GlslPreprocessor, lineMarksLeadBackToTheFiles) {
  const ExpandedSource source =
      expand({{"main.comp.glsl", "one\n#include \"a.glsl\"\nthree\n"}, {"a.glsl", "first\nsecond\n"}});
  EXPECT_EQ(source.text,
            "#version 450 core\n#line 1 0\none\n"
            "#ifndef LIMN_INCLUDED_1\n#define LIMN_INCLUDED_1\n#line 1 1\nfirst\nsecond\n#endif\n"
            "#line 3 0\nthree\n");
}

TEST(GlslPreprocessor, filesAreIncludedOnce) {
  const Files files = {{"main.comp.glsl", "#include \"a.glsl\"\n#include \"b.glsl\"\n#include \"a.glsl\"\n"},
                       {"a.glsl", "text a\n"},
                       {"b.glsl", "#ifndef B_GLSL\n#define B_GLSL\n#include \"a.glsl\"\ntext b\n#endif\n"}};
  const std::string text = expand(files).text;
  EXPECT_EQ(occurrences(text, "text a\n"), 1);
  EXPECT_EQ(occurrences(text, "text b\n"), 1);
}

// The first include may be skipped by the compiler, so the second must still bring the text.
TEST(GlslPreprocessor, anIncludeUnderAConditionDoesNotHideALaterOne) {
  const Files files = {
      {"main.comp.glsl",
       "#ifdef LIMN_X\n#include \"a.glsl\"\n#endif\n#include \"a.glsl\"\n#include \"a.glsl\"\n"},
      {"a.glsl", "text a\n"}};
  EXPECT_EQ(occurrences(expand(files).text,
                        "#ifndef LIMN_INCLUDED_1\n#define LIMN_INCLUDED_1\n#line 1 1\ntext a\n"),
            2);
}

TEST(GlslPreprocessor, filesUnderAConditionAreIncludedOnceThere) {
  const Files files = {
      {"main.comp.glsl", "#ifdef LIMN_X\n#include \"a.glsl\"\n#endif\n#include \"b.glsl\"\n"},
      {"a.glsl", "#include \"b.glsl\"\n#include \"c.glsl\"\n"},
      {"b.glsl", "text b\n"},
      {"c.glsl", "#include \"b.glsl\"\ntext c\n"}};
  const std::string text = expand(files).text;
  EXPECT_EQ(occurrences(text, "text b\n"), 2) << "once where LIMN_X is defined, and once for where it is not";
  EXPECT_EQ(occurrences(text, "text c\n"), 1);
}

TEST(GlslPreprocessor, whatTheDefinesKeepFromBeingReadIsLeftOut) {
  const Files files = {{"main.comp.glsl",
                        "#if MODELS\n#include \"a.glsl\"\n#else\n#include \"b.glsl\"\n#endif\n"
                        "#if MODELS || OTHER\n#include \"c.glsl\"\n#endif\n"},
                       {"a.glsl", "text a\n"},
                       {"b.glsl", "#if (MODELS & 6) != 0\n#include \"no.glsl\"\n#endif\ntext b\n"},
                       {"c.glsl", "text c\n"}};
  const ExpandedSource none = expand(files, {{"MODELS", "0"}});
  EXPECT_THAT(none.files, ElementsAre("main.comp.glsl", "b.glsl", "c.glsl"));
  EXPECT_THAT(none.text, HasSubstr("#if MODELS\n#line 3 0\n#else\n"));
  EXPECT_THAT(none.text, HasSubstr("#if (MODELS & 6) != 0\n#line 3 1\n#endif\ntext b\n"));
  EXPECT_THAT(expand(files, {{"MODELS", "1"}}).files, ElementsAre("main.comp.glsl", "a.glsl", "c.glsl"));
  EXPECT_THAT(expand(files).files, ElementsAre("main.comp.glsl", "a.glsl", "b.glsl", "c.glsl"));
}

TEST(GlslPreprocessor, aDefineThatAFileTakesBackDecidesNothing) {
  const Files files = {
      {"main.comp.glsl", "#undef MODE\n#define MODE 1\n#if MODE\n#include \"a.glsl\"\n#endif\n"},
      {"a.glsl", "text a\n"}};
  EXPECT_THAT(expand(files, {{"MODE", "0"}}).text, HasSubstr("text a\n"));
}

// A compiler that skips an include does not read the marks in it.
TEST(GlslPreprocessor, linesBehindASkippedIncludeAreCounted) {
  const Files files = {{"main.comp.glsl", "#ifdef LIMN_X\n#include \"a.glsl\"\n#else\nelse\n#endif\nlast\n"},
                       {"a.glsl", "text a\n"}};
  EXPECT_EQ(expand(files).text,
            "#version 450 core\n#line 1 0\n#ifdef LIMN_X\n"
            "#ifndef LIMN_INCLUDED_1\n#define LIMN_INCLUDED_1\n#line 1 1\ntext a\n#endif\n#line 3 0\n"
            "#else\n#line 4 0\nelse\n#endif\n#line 6 0\nlast\n");
}

TEST(GlslPreprocessor, linesBehindAConditionOfTwoLinesAreCounted) {
  const Files files = {
      {"main.comp.glsl", "#ifdef X\n#include \"a.glsl\"\n#elif Y || \\\n  Z\nelse\n#endif\nlast\n"},
      {"a.glsl", "text a\n"}};
  EXPECT_THAT(expand(files).text,
              HasSubstr("#elif Y || \\\n  Z\n#line 5 0\nelse\n#endif\n#line 7 0\nlast\n"));
}

TEST(GlslPreprocessor, commentsHideDirectives) {
  const Files files = {{"main.comp.glsl",
                        "// #include \"x.glsl\"\n/* #include \"x.glsl\"\n#include \"x.glsl\"\n*/ #include "
                        "\"a.glsl\" // end\n"},
                       {"a.glsl", "text a\n"}};
  EXPECT_THAT(expand(files).text, HasSubstr("text a\n"));
}

TEST(GlslPreprocessor, problemsAreReportedWithFileAndLine) {
  EXPECT_EQ(errorOf({}), "shader file 'main.comp.glsl' does not exist");
  EXPECT_EQ(errorOf({{"main.comp.glsl", "\n#include \"no.glsl\"\n"}}),
            "main.comp.glsl:2: include 'no.glsl' not found (looked for 'no.glsl' and 'no.glsl')");
  EXPECT_THAT(errorOf({{"main.comp.glsl", "#include <a.glsl>\n"}}),
              HasSubstr("main.comp.glsl:1: include <a.glsl> is not"));
  EXPECT_THAT(errorOf({{"main.comp.glsl", "#include \"../../etc/passwd\"\n"}}), HasSubstr("not found"));
  EXPECT_EQ(errorOf({{"main.comp.glsl", "#include \"a.glsl\"\n"},
                     {"a.glsl", "\n#include \"b.glsl\"\n"},
                     {"b.glsl", "#include \"a.glsl\"\n"}}),
            "b.glsl:1: 'a.glsl' includes itself: main.comp.glsl -> a.glsl -> b.glsl -> a.glsl");
  EXPECT_THAT(errorOf({{"main.comp.glsl", "#version 430\n"}}), HasSubstr("main.comp.glsl:1: #version"));
  EXPECT_THAT(errorOf({{"main.comp.glsl", ""}}, {{"A B", "1"}}), HasSubstr("shader define 'A B'"));
  EXPECT_THAT(errorOf({{"main.comp.glsl", ""}}, {{"A", "1\n#error"}}), HasSubstr("shader define 'A'"));
}

TEST(GlslPreprocessor, unresolvedIncludesUnderAConditionAreLeftToTheCompiler) {
  const ExpandedSource source =
      expand({{"main.comp.glsl", "#ifdef __cplusplus\n#include <cmath>\n#include \"core/x.h\"\n#endif\n"}});
  EXPECT_THAT(source.text, HasSubstr("#error include <cmath>"));
  EXPECT_THAT(source.text, HasSubstr("#error include 'core/x.h' not found"));
}

TEST(GlslPreprocessor, testedMacrosMustBeDefined) {
  const auto text = [](const std::string& body) { return expand({{"main.comp.glsl", body}}).text; };
  const std::string required =
      "#ifndef LIMN_A\n#line 1 0\n#error LIMN_A is tested but not defined\n#endif\n#line 1 0\n";
  EXPECT_THAT(text("#if LIMN_A == 1\n#endif\n"), HasSubstr(required));
  EXPECT_THAT(text("#if 0\n#elif LIMN_A > 1 && LIMN_A < 5\n#endif\n"), HasSubstr(required));
  EXPECT_EQ(occurrences(text("#if LIMN_A > 1 && LIMN_A < 5\n#endif\n"), "#error"), 1);
  EXPECT_THAT(text("#if 1 || \\\n  LIMN_A\n#endif\n"), HasSubstr(required));
  EXPECT_THAT(text("#ifdef LIMN_A\n#elif OTHER\n#endif\n"), Not(HasSubstr("#error")));
  EXPECT_THAT(text("#if defined(LIMN_A) && LIMN_A == 1\n#endif\n"), Not(HasSubstr("#error")));
  EXPECT_THAT(text("#if !defined LIMN_A\n#elif LIMN_A == 1\n#endif\n"), Not(HasSubstr("#error")));
}

TEST(GlslPreprocessor, readsTheLogsOfThreeCompilers) {
  const std::vector<std::string> files = {"main.comp.glsl", "glsl/a.glsl"};
  const auto parse = [&](std::string_view log) {
    std::vector<std::string> texts;
    for (const ShaderDiagnostic& diagnostic : parseShaderLog(log, files)) {
      texts.push_back(diagnostic.text() + (diagnostic.warning ? " [warning]" : ""));
    }
    return texts;
  };
  EXPECT_THAT(
      parse("1:12(3): error: `x' undeclared\n0:1(2): warning: `y' used uninitialized\n"
            "0:3(2): preprocessor error: #error LIMN_A\n"),
      ElementsAre("glsl/a.glsl:12: `x' undeclared", "main.comp.glsl:1: `y' used uninitialized [warning]",
                  "main.comp.glsl:3: #error LIMN_A"));
  EXPECT_THAT(
      parse("1(12) : error C1503: undefined variable \"x\"\n0(4) : warning C7050: \"y\" might be unset\n"),
      ElementsAre("glsl/a.glsl:12: undefined variable \"x\"",
                  "main.comp.glsl:4: \"y\" might be unset [warning]"));
  EXPECT_THAT(parse("ERROR: 1:12: 'x' : undeclared identifier\n"),
              ElementsAre("glsl/a.glsl:12: 'x' : undeclared identifier"));
  EXPECT_THAT(parse("Vertex info\n-----------\n9:1(1): error: of no known file\n"), IsEmpty());
}

TEST(StandaloneGlsl, SaysWhereLinesAreFrom) {
  const std::string text = standaloneGlsl(expand(
      {{"main.comp.glsl", "#include \"a.glsl\"\nvoid main() { f(); }\n"}, {"a.glsl", "void f() {}\n"}}));
  EXPECT_EQ(text,
            "#version 450 core\n#ifndef LIMN_INCLUDED_1\n#define LIMN_INCLUDED_1\n// ---- a.glsl\nvoid f() "
            "{}\n#endif\n"
            "// ---- main.comp.glsl\nvoid main() { f(); }\n");
}

TEST(StandaloneGlsl, LeavesOutWhatOnlyCppReads) {
  const std::string text =
      standaloneGlsl(expand({{"main.comp.glsl",
                              "#ifdef __cplusplus\n#include <cmath>\n#if A\nint x;\n#else\nint y;\n#endif\n"
                              "#else  // GLSL\n#if B\nint z;\n#endif\n#endif\n"
                              "#ifndef __cplusplus\nvoid main() {}\n#else\nint w;\n#endif\nint last;\n"}}));
  EXPECT_EQ(text,
            "#version 450 core\n#if B\n// ---- main.comp.glsl\nint z;\n#endif\nvoid main() {}\nint last;\n");
}

}  // namespace
}  // namespace limn::gpu
