// What a suite names and is not there is said before anything is measured.
#include "core/session/suite_check.h"

#include <gmock/gmock.h>

namespace limn::session {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SuiteCheckTest : public testing::Test {
 protected:
  SuiteCheckTest() { case_.scene = "gem"; }
  std::vector<std::string> missing(const std::vector<bench::Case>& cases) {
    return missingThings(cases, registry_, [this] { ++signsOfLife_; });
  }
  std::vector<std::string> missing(int copies = 1) {
    return missing(std::vector<bench::Case>(static_cast<size_t>(copies), case_));
  }
  TechniqueRegistry registry_{{}};
  bench::Case case_;
  int signsOfLife_ = 0;
};

TEST_F(SuiteCheckTest, NothingIsSaidOfWhatIsThere) {
  EXPECT_THAT(missing(), IsEmpty());
  EXPECT_EQ(signsOfLife_, 1);
}

TEST_F(SuiteCheckTest, EachThingIsSaidOnce) {
  case_.light = "no_such_light";
  case_.camera = "no_such_camera";
  EXPECT_THAT(missing(3), ElementsAre(HasSubstr("no_such_camera"), HasSubstr("no_such_light")));
  EXPECT_EQ(signsOfLife_, 1) << "of one scene";
}

/// Sizes of lights are set in the scene that is open.
TEST_F(SuiteCheckTest, AScenesLightsAreResizedWithoutOpeningItAgain) {
  std::vector<bench::Case> cases;
  for (const double size : {0.0, 0.3, 0.6}) {
    case_.lightSize = size;
    cases.push_back(case_);
  }
  for (bench::Case& c : cases) c.scene = "lights";
  EXPECT_THAT(missing(cases), IsEmpty());
  EXPECT_EQ(signsOfLife_, 1);
  for (bench::Case& c : cases) c.scene = "cornell_box";
  EXPECT_THAT(missing(cases), ElementsAre(HasSubstr("--light-size 0.3"), HasSubstr("--light-size 0.6")));
  EXPECT_EQ(signsOfLife_, 2);
}

/// Scenes may have an environment of their own, which only opening them tells.
TEST_F(SuiteCheckTest, LightsOfAnEnvironmentNeedOne) {
  case_.environmentLights = 0.1;
  EXPECT_THAT(missing(2), ElementsAre(HasSubstr("gem: --environment-lights needs --environment")));
  case_.scene = "nine_spheres";
  EXPECT_THAT(missing(), IsEmpty());
}

TEST_F(SuiteCheckTest, FilesAndTechniquesAreLookedFor) {
  case_.scene = "no_such_scene";
  case_.technique = "no_such_technique";
  EXPECT_THAT(missing(), ElementsAre(HasSubstr("no_such_technique"), HasSubstr("no_such_scene")));
  EXPECT_EQ(signsOfLife_, 0);
}

TEST_F(SuiteCheckTest, ParametersNeedTheirTechnique) {
  case_.parameters = {{"pcss.filter_samples", "16"}};
  EXPECT_THAT(missing(), ElementsAre(HasSubstr("which --technique does not")));
}

}  // namespace
}  // namespace limn::session
