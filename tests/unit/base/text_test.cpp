// Text of others, as messages show it.
#include "core/base/text.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>

namespace limn {
namespace {

TEST(ParseWhole, TakesWholeNumbersInDecimal) {
  EXPECT_EQ(parseWhole<int>("0"), 0);
  EXPECT_EQ(parseWhole<int>("007"), 7);
  EXPECT_EQ(parseWhole<int>("-12"), -12);
  for (const char* other : {"", "-", "+1", " 1", "1 ", "1x", "1.0", "1e3", "0x10", "--1", "1-", "one"}) {
    EXPECT_EQ(parseWhole<int>(other), std::nullopt) << other;
    EXPECT_EQ(parseWhole<std::size_t>(other), std::nullopt) << other;
  }
}

TEST(ParseWhole, TakesWhatTheTypeHolds) {
  EXPECT_EQ(parseWhole<int>("2147483647"), 2147483647);
  EXPECT_EQ(parseWhole<int>("-2147483648"), -2147483647 - 1);
  EXPECT_EQ(parseWhole<int>("2147483648"), std::nullopt);
  EXPECT_EQ(parseWhole<int>("-2147483649"), std::nullopt);
  EXPECT_EQ(parseWhole<std::size_t>("18446744073709551615"), 18446744073709551615u);
  EXPECT_EQ(parseWhole<std::size_t>("18446744073709551616"), std::nullopt);
  EXPECT_EQ(parseWhole<std::size_t>("-1"), std::nullopt) << "which is no large number";
}

TEST(ParseNumber, TakesOneSign) {
  EXPECT_EQ(parseNumber("+2.5"), 2.5);
  EXPECT_EQ(parseNumber("-2.5"), -2.5);
  for (const char* other : {"+-2.5", "-+2.5", "++2.5", "+", "-", ""})
    EXPECT_EQ(parseNumber(other), std::nullopt) << other;
}

TEST(LowerCase, ChangesCapitalsOfAsciiAlone) {
  EXPECT_EQ(lowerCase("SKY.Hdr 9_@[`{"), "sky.hdr 9_@[`{");
  EXPECT_EQ(lowerCase("\xc3\x89"), "\xc3\x89");
  EXPECT_EQ(lowerCase(""), "");
}

TEST(OneLine, IsOneLine) {
  EXPECT_EQ(oneLine("a\nb\tc\x7f d \r\n"), "a?b?c? d");
  EXPECT_EQ(oneLine("a\302\23331mb\302\240c"), "a?31mb\302\240c") << "terminals obey U+009B";
  EXPECT_EQ(oneLine(""), "");
  EXPECT_EQ(oneLine("abc", 3), "abc");
  EXPECT_EQ(oneLine("abcd", 3), "abc...");
}

/// Half a character would be refused by whatever takes UTF-8 alone, JSON for one.
TEST(OneLine, CutsNoCharacterOfUtf8) {
  const std::string two = "\xc3\xa9", three = "\xe2\x82\xac", four = "\xf0\x9f\x98\x80";
  for (const std::string& character : {two, three, four})
    for (std::size_t shown = 0; shown <= character.size(); ++shown) {
      const std::string whole = shown == character.size() ? character : "";
      EXPECT_EQ(oneLine("ab" + character + "c", 2 + shown), "ab" + whole + "...") << character << shown;
    }
  EXPECT_EQ(oneLine(two, 1), "...");
  EXPECT_EQ(oneLine(two, 2), two);
}

TEST(OneLine, ShowsWhatIsNoUtf8) {
  EXPECT_EQ(oneLine(std::string(10, '\x80'), 6), std::string(6, '\x80') + "...");
  EXPECT_EQ(oneLine("a\xff\xfe", 2), "a\xff...");
}

}  // namespace
}  // namespace limn
