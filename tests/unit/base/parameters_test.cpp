#include "core/base/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace limn {
namespace {

using testing::HasSubstr;

constexpr const char* kPatterns[] = {"grid", "random"};
constexpr Parameter kDeclared[] = {
    integer("shadow_map_size", 1024, {16, 16384}, "texels", "Size"),
    real("bias", 1.5, {0, 64}, "texels", "Bias"),
    boolean("early_out", true, "Skip lit pixels"),
    choice("pattern", 1, kPatterns, "Pattern"),
};

std::string failure(std::string_view name, std::string_view text) {
  ParameterValues values("demo", kDeclared);
  try {
    values.set(name, text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

TEST(Parameters, StartAtTheirDefaults) {
  const ParameterValues values("demo", kDeclared);
  EXPECT_EQ(values.integer("shadow_map_size"), 1024);
  EXPECT_FLOAT_EQ(values.real("bias"), 1.5f);
  EXPECT_TRUE(values.boolean("early_out"));
  EXPECT_EQ(values.choice("pattern"), 1);
}

TEST(Parameters, SayWhichWereDeclared) {
  const ParameterValues values("demo", kDeclared);
  EXPECT_TRUE(values.has("shadow_map_size"));
  EXPECT_TRUE(values.has("pattern"));
  EXPECT_FALSE(values.has("shadow_map"));
  EXPECT_FALSE(ParameterValues().has("pattern"));
}

TEST(Parameters, BothEndsOfARangeAreAccepted) {
  ParameterValues values("demo", kDeclared);
  values.set("shadow_map_size", "16");
  EXPECT_EQ(values.integer("shadow_map_size"), 16);
  values.set("shadow_map_size", "16384");
  EXPECT_EQ(values.integer("shadow_map_size"), 16384);
  values.set("pattern", "grid");
  EXPECT_EQ(values.choice("pattern"), 0);
}

TEST(Parameters, RefuseByNameValueAndRange) {
  EXPECT_THAT(failure("shadow_map_size", "15"), HasSubstr("demo.shadow_map_size: '15'"));
  EXPECT_THAT(failure("shadow_map_size", "15"), HasSubstr("from 16 to 16384 texels"));
  for (const char* text : {"16.5", "1e9", "nan", "inf", "", "12x", "-1", " 16"})
    EXPECT_THAT(failure("shadow_map_size", text), HasSubstr("whole number")) << text;
  EXPECT_THAT(failure("bias", "65"), HasSubstr("a number from 0 to 64"));
  EXPECT_THAT(failure("early_out", "maybe"), HasSubstr("true or false"));
  EXPECT_THAT(failure("pattern", "spiral"), HasSubstr("grid or random"));
}

TEST(Parameters, UnknownNamesAreAnsweredWithNearOnes) {
  EXPECT_THAT(failure("shadow_map_sise", "16"), HasSubstr("did you mean shadow_map_size?"));
  EXPECT_THAT(failure("zzz", "16"), HasSubstr("it has shadow_map_size, bias, early_out and pattern"));
}

TEST(Parameters, PrintWhatTheyWouldParse) {
  ParameterValues values("demo", kDeclared);
  values.set("bias", "0.25");
  ParameterValues copy("demo", kDeclared);
  for (const auto& [name, text] : values.printed()) copy.set(name, text);
  EXPECT_EQ(copy.printed(), values.printed());
}

/// Rows of results go by what is printed.
TEST(Parameters, ZeroHasNoSign) {
  constexpr Parameter signedOnes[] = {integer("offset", 1, {-4, 4}, "texels", "Offset"),
                                      real("shift", 1, {-4, 4}, "texels", "Shift")};
  ParameterValues values("demo", signedOnes);
  for (const char* name : {"offset", "shift"}) values.set(name, "-0");
  for (const auto& [name, text] : values.printed()) EXPECT_EQ(text, "0") << name;
}

TEST(Parameters, AskingForWhatWasNotDeclaredIsABug) {
  const ParameterValues values("demo", kDeclared);
  EXPECT_THROW(values.integer("bias"), std::logic_error);
  EXPECT_THROW(values.real("unknown"), std::logic_error);
}

}  // namespace
}  // namespace limn
