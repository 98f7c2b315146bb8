// What a scene without light looks like to somebody who renders it for the first time.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "tests/cli/channels.h"
#include "tests/cli/limn_program.h"
#include "tests/support/gltf_builder.h"

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

/// A sphere of white metal (glTF's default) of roughness 0.3.
std::filesystem::path metalSphere(const TemporaryFolder& folder) {
  constexpr int rings = 48, columns = 96;
  std::vector<glm::vec3> points;
  std::vector<std::uint32_t> triangles;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j <= columns; ++j) {
      const double polar = std::numbers::pi * i / rings, azimuth = 2 * std::numbers::pi * j / columns;
      points.emplace_back(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                          std::sin(polar) * std::cos(azimuth));
      if (i == rings || j == columns) continue;
      const auto at = static_cast<std::uint32_t>(i * (columns + 1) + j), below = at + columns + 1;
      triangles.insert(triangles.end(), {at, below, at + 1, at + 1, below, below + 1});
    }
  GltfBuilder builder;
  const int metal = builder.append("materials", {{"pbrMetallicRoughness", {{"roughnessFactor", 0.3}}}});
  const int positions = builder.vec3(points), normals = builder.vec3(points);
  builder.meshNode(
      builder.mesh({{"POSITION", positions}, {"NORMAL", normals}}, builder.indices(triangles), metal));
  const std::vector<std::byte> bytes = builder.glb();
  const std::filesystem::path file = folder / "metal.glb";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file;
}

/// The studio's radiance is at least 0.05, and white metal of this roughness reflects more than nine tenths.
/// Without the studio there are two highlights and nothing else. Nothing shadows a sphere, so that picture
/// and reference differ by the split sum's error alone: 7 % at most (prefiltered_environment) of what comes
/// from the studio, which is two fifths.
TEST(DefaultLights, MetalsReflectTheStudio) {
  const TemporaryFolder folder;
  const std::string metal = metalSphere(folder).string();
  const auto reflected = [&](std::vector<std::string> command, const std::string& scale) {
    const std::string out = (folder / (command[0] + scale + ".exr")).string();
    command.insert(command.end(), {metal, "--size", "128x128", "--environment-scale", scale, "--out", out});
    const Outcome outcome = limn(command);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const Channels picture(out);
    std::vector<float> values;
    for (size_t i = 0; i < picture.size(); ++i)
      if (picture.at(i, "coverage") == 1) values.push_back(picture.at(i, "R"));
    EXPECT_GT(values.size(), 3000u);
    std::ranges::sort(values);
    return values;
  };
  const std::vector<float> lit = reflected({"render"}, "1"), bare = reflected({"render"}, "0");
  EXPECT_GT(lit.front(), 0.045f);
  EXPECT_LT(bare[bare.size() / 2], 0.045f) << "half of the sphere is darker";
  const auto mean = [](const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += double(value);
    return sum / static_cast<double>(values.size());
  };
  const std::vector<float> traced = reflected({"reference", "--term", "direct", "--spp", "64"}, "1");
  EXPECT_NEAR(mean(lit) / mean(traced), 1, 0.028);
}

}  // namespace
}  // namespace limn::test
