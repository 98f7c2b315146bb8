// What is certain of the conditions in GLSL files, against the rules of C's preprocessor.
#include "core/gpu/private/glsl_conditions.h"

#include <gtest/gtest.h>

namespace limn::gpu {
namespace {

Holds holds(std::string_view condition) {
  return evaluate(
      condition,
      {{"ZERO", "0"}, {"SIX", "6"}, {"LESS", "-1"}, {"EMPTY", ""}, {"UNSIGNED", "1u"}, {"HEX", "0x1"}});
}

TEST(GlslConditions, AreAnsweredByDefinesAndNumbers) {
  for (const char* condition : {"1", "SIX", "!ZERO", "!!SIX", "LESS", "(SIX & 2) != 0", "SIX & 2", "SIX == 6",
                                "ZERO || SIX", "defined SIX", "defined(ZERO) && SIX > 1", "SIX*2>=12",
                                "1 + 2 * 3 == 7", "2 - 1 - 1 == 0", "SIX < 7 && SIX <= 6", "1 | 2 == 3",
                                "0 & 1 || 1", "ZERO == 0 && (SIX == 1 || SIX == 6)", " SIX\t!=  5 "})
    EXPECT_EQ(holds(condition), Holds::yes) << condition;
  for (const char* condition : {"0", "ZERO", "!SIX", "(SIX & 1) != 0", "SIX & 2 == 2", "LESS > 0",
                                "SIX && ZERO", "!defined(SIX)", "ZERO || !SIX", "LESS == 1 || ZERO"})
    EXPECT_EQ(holds(condition), Holds::no) << condition;
}

TEST(GlslConditions, AreUnknownWhereFilesMayDecide) {
  for (const char* condition : {"OTHER",
                                "!OTHER",
                                "defined OTHER",
                                "!defined(OTHER)",
                                "OTHER || ZERO",
                                "OTHER && SIX",
                                "OTHER == OTHER",
                                "EMPTY",
                                "UNSIGNED",
                                "HEX",
                                "010 == 8",
                                "",
                                "SIX SIX",
                                "(SIX",
                                "SIX)",
                                "SIX <<1",
                                "-1",
                                "SIX ? 1 : 0",
                                "FUNCTION(1)",
                                "SIX ==",
                                "99999999999",
                                "2147483647 + SIX > 0",
                                "LESS - 2147483647 - SIX < 0",
                                "65536 * 65536 * 65536 * 65536 == 0"})
    EXPECT_EQ(holds(condition), Holds::unknown) << condition;
  EXPECT_EQ(holds("46340 * 46340 > 0"), Holds::yes) << "32 bits hold it";
  EXPECT_EQ(holds("OTHER && ZERO"), Holds::no);
  EXPECT_EQ(holds("SIX || OTHER"), Holds::yes);
  EXPECT_EQ(holds("defined(OTHER) && ZERO"), Holds::no);
}

/// What compilers read of each line, where ONE is 1 and OTHER is what files make of it: y, n or ?.
std::string read(const std::string& text) {
  const GlslFile file(text);
  OpenConditions conditions;
  std::string answers;
  for (const GlslLine& line : file.lines) {
    conditions.follow(line, {{"ONE", "1"}});
    if (line.directive.empty()) answers += "n?y"[static_cast<int>(conditions.here())];
  }
  return answers;
}

TEST(GlslConditions, ChainsReadOneBranch) {
  EXPECT_EQ(read("a\n#if ONE\nb\n#elif OTHER\nc\n#else\nd\n#endif\ne\n"), "yynny");
  EXPECT_EQ(read("#if !ONE\na\n#elif ONE\nb\n#else\nc\n#endif\n"), "nyn");
  EXPECT_EQ(read("#if OTHER\na\n#elif ONE\nb\n#else\nc\n#endif\n"), "??n");
  EXPECT_EQ(read("#ifdef OTHER\na\n#else\nb\n#endif\n#ifndef ONE\nc\n#else\nd\n#endif\n"), "??ny");
  EXPECT_EQ(read("#if !ONE\n#if ONE\na\n#endif\nb\n#endif\nc\n"), "nny");
  EXPECT_EQ(read("#if OTHER\n#if ONE\na\n#else\nb\n#endif\n#endif\n"), "?n");
  EXPECT_EQ(read("#ifndef FILE_GLSL\n#define FILE_GLSL\na\n#endif\n"), "y") << "the file's own guard";
}

}  // namespace
}  // namespace limn::gpu
