// What a scene without light looks like to somebody who renders it for the first time.
#include <fstream>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A triangle with neither light nor environment.
std::filesystem::path darkScene(const TemporaryFolder& folder) {
  const std::filesystem::path file = folder / "dark.gltf";
  std::ofstream(file) << R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
    "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  return file;
}

TEST(DefaultLights, SceneWithoutLightGetsDefaultLightsAndIsToldSo) {
  const TemporaryFolder folder;
  const std::string dark = darkScene(folder).string();
  const auto render = [&](const std::string& lights) {
    return limn({"render", dark, "--size", "32x24", "--default-lights", lights, "--out",
                 (folder / (lights + ".png")).string()});
  };
  const Outcome lit = render("auto");
  EXPECT_EQ(lit.status, 0) << lit.err;
  EXPECT_THAT(lit.err, AllOf(HasSubstr("warning"), HasSubstr("default lights"), HasSubstr("--environment")));
  const Outcome unlit = render("off");
  EXPECT_EQ(unlit.status, 0) << unlit.err;
  EXPECT_THAT(unlit.err, AllOf(HasSubstr("warning"), HasSubstr("neither lights nor an environment")));
  EXPECT_NE(contents(folder / "auto.png"), contents(folder / "off.png"));
  EXPECT_EQ(limn({"reference", dark, "--term", "direct", "--light", "headlight", "--spp", "2", "--size",
                  "16x12", "--out", (folder / "reference.exr").string()})
                .status,
            0);
}

}  // namespace
}  // namespace limn::test
