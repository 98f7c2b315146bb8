// How techniques are named in flags, suites and rows.
#include "core/question/technique_names.h"

#include <gmock/gmock.h>

namespace limn {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;
using testing::SizeIs;

TEST(TechniqueNames, AreJoinedByCommas) {
  EXPECT_THAT(namedTechniques(""), IsEmpty());
  const auto named = namedTechniques("vssm,,airlight,");
  ASSERT_THAT(named, SizeIs(3));
  EXPECT_EQ(named[0].name, "vssm");
  EXPECT_EQ(named[1].name, "");
  EXPECT_EQ(named[2].name, "airlight");
  for (const NamedTechnique& one : named) EXPECT_EQ(one.terms, std::nullopt);
}

TEST(TechniqueNames, TermsStandAfterAColon) {
  const auto named = namedTechniques("vssm,a:indirect,b:direct+media,c:,d:+x");
  ASSERT_THAT(named, SizeIs(5));
  EXPECT_EQ(named[0].terms, std::nullopt);
  EXPECT_EQ(named[1].name, "a");
  EXPECT_THAT(named[1].terms, Optional(ElementsAre("indirect")));
  EXPECT_THAT(named[2].terms, Optional(ElementsAre("direct", "media")));
  EXPECT_EQ(named[3].name, "c");
  EXPECT_THAT(named[3].terms, Optional(ElementsAre("")));
  EXPECT_THAT(named[4].terms, Optional(ElementsAre("", "x")));
}

TEST(TechniqueNames, ParametersOfTheOnlyTechniqueAreShort) {
  EXPECT_EQ(shortParameter("pcss", "pcss.bias"), "bias");
  EXPECT_EQ(shortParameter("pcss:visibility", "pcss.bias"), "bias");
  EXPECT_EQ(shortParameter("pcss", "pcssm.bias"), "pcssm.bias");
  EXPECT_EQ(shortParameter("pcss,airlight", "pcss.bias"), "pcss.bias");
  EXPECT_EQ(shortParameter("", "pcss.bias"), "pcss.bias");
}

}  // namespace
}  // namespace limn
