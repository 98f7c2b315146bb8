// What cases of a bench are measured with.
#include "core/session/case_origins.h"

#include <gmock/gmock.h>

#include "core/base/version.h"
#include "core/reference/reference.h"
#include "core/session/view.h"

namespace limn::session {
namespace {

using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

class CaseOriginsTest : public testing::Test {
 protected:
  static bench::Case gem(const std::string& technique) {
    bench::Case c;
    c.scene = "gem";
    c.technique = technique;
    return c;
  }
  TechniqueRegistry registry_{{}};
  CaseOrigins origins_{registry_};
};

TEST_F(CaseOriginsTest, AreHashesOfTheProgramAndTheScene) {
  const bench::Provenance origin = origins_.of(gem(""));
  EXPECT_THAT(origin.program, SizeIs(32));
  EXPECT_THAT(origin.scene, SizeIs(32));
  EXPECT_THAT(origin.modules, IsEmpty());
  EXPECT_EQ(bench::staleness(origin, CaseOrigins(registry_).of(gem(""))), "")
      << "another run, the same files";
}

/// A scene may turn out to have no light when it is loaded.
TEST_F(CaseOriginsTest, CountTheMapOfTheDefaultLights) {
  bench::Case off = gem("");
  off.defaultLights = "off";
  EXPECT_NE(origins_.of(off).scene, origins_.of(gem("")).scene);
  bench::Case studio = gem("");
  studio.environment = "studio";
  EXPECT_EQ(origins_.of(studio).scene, origins_.of(gem("")).scene) << "the same files";
}

TEST_F(CaseOriginsTest, SayWhatIsMissing) {
  bench::Case c = gem("first,,second");
  c.scene = "no_such_scene";
  const bench::Provenance origin = origins_.of(c);
  EXPECT_EQ(origin.scene, "missing");
  ASSERT_THAT(origin.modules, SizeIs(2));
  EXPECT_EQ(origin.modules[0].technique, "first");
  EXPECT_EQ(origin.modules[1].technique, "second");
  EXPECT_EQ(origin.modules[1].hash, "missing");
}

TEST_F(CaseOriginsTest, ModulesAreNamedWithoutTheTermsTheyAreAskedFor) {
  const bench::Provenance origin = origins_.of(gem("first,second:direct+media"));
  ASSERT_THAT(origin.modules, SizeIs(2));
  EXPECT_EQ(origin.modules[0].technique, "first");
  EXPECT_EQ(origin.modules[1].technique, "second");
}

TEST_F(CaseOriginsTest, ASeparationFloorHasNoModules) {
  EXPECT_THAT(origins_.of(gem(bench::kSeparationFloor)).modules, IsEmpty());
}

/// Each of the libraries that a program of limn is made of; a change of any makes rows stale.
TEST(FileOfFunction, IsTheLibraryThatHasIt) {
  const auto name = [](const void* function) { return bench::fileOfFunction(function).filename().string(); };
  EXPECT_THAT(name(reinterpret_cast<const void*>(&version)), StartsWith("liblimn.so"));
  EXPECT_THAT(name(reinterpret_cast<const void*>(&reference::contentHash)),
              StartsWith("liblimn_reference.so"));
  EXPECT_THAT(name(reinterpret_cast<const void*>(&bench::hashOfFiles)), StartsWith("liblimn_bench.so"));
  EXPECT_THAT(name(reinterpret_cast<const void*>(&open)), StartsWith("liblimn_session.so"));
}

}  // namespace
}  // namespace limn::session
