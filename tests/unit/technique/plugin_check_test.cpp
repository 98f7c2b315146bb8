// What a technique may declare. Modules with every other flaw are loaded in tests/cli/plugin_test.cpp.
#include "core/technique/private/plugin_check.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace limn {
namespace {

/// What is wrong with a technique that answers these terms, has these parameters and is right otherwise.
std::string problemOf(TermSet terms, std::span<const Parameter> parameters = {}) {
  const TechniqueInfo info{.name = "probe",
                           .title = "A probe",
                           .source = "a test",
                           .terms = terms,
                           .parameters = parameters,
                           .stress = {}};
  TechniquePlugin plugin{};
  plugin.info = &info;
  plugin.sources = [] { return std::span<const gpu::EmbeddedSource>(); };
  plugin.create = []() -> std::unique_ptr<Technique> { return nullptr; };
  return pluginProblem(plugin, "probe");
}

TEST(PluginCheck, TermsAreThoseThatTechniquesMayAnswer) {
  for (const TermInfo& info : kTerms)
    EXPECT_EQ(problemOf(termSet(info.term)).empty(), info.answerable) << info.name;
  EXPECT_EQ(problemOf(kAnswerableTerms), "");
  EXPECT_EQ(problemOf(Term::direct | Term::final), "it answers final, which is not for techniques to answer");
}

TEST(PluginCheck, NoTermsAndUnknownOnesAreRefused) {
  EXPECT_EQ(problemOf(0), "it answers the terms 0x0, which are none or not known");
  for (TermSet bit = 1; bit != 0; bit <<= 1) {
    const bool known = std::ranges::any_of(kTerms, [&](const TermInfo& t) { return termSet(t.term) == bit; });
    if (known) continue;
    EXPECT_THAT(problemOf(termSet(Term::direct) | bit), testing::HasSubstr("none or not known")) << bit;
  }
}

TEST(PluginCheck, WholeNumbersAreThoseOfAnInt) {
  const auto problemOfInteger = [](double value, ParameterRange range) {
    Parameter parameter = integer("count", 0, range, "", "How many");
    parameter.defaultValue = value;
    return problemOf(termSet(Term::direct), {&parameter, 1});
  };
  EXPECT_EQ(problemOfInteger(1, {-2147483648.0, 2147483647.0}), "");
  const std::string wanted = " where a whole number of 32 bits is expected";
  EXPECT_THAT(problemOfInteger(1, {0, 3e9}), testing::EndsWith(wanted));
  EXPECT_EQ(problemOfInteger(1, {0.5, 2}), "its parameter count has 0.5" + wanted);
  EXPECT_EQ(problemOfInteger(1.5, {0, 2}), "its parameter count has 1.5" + wanted);
}

}  // namespace
}  // namespace limn
