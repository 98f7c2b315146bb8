// The scene library as written to disk: valid, complete, the size it promises, and the same bytes every time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/scene_io/load.h"
#include "core/shading/environment_decomposition.h"
#include "tests/support/glb.h"
#include "tests/support/paths.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

using limn::test::bytesOf;
using limn::test::Glb;
using limn::test::kAssets;
using limn::test::Vec3;
using limn::test::Vec4;

// clang-format off
const char* const kScenes[] = {
    "arcade_dark", "atrium", "atrium_robots", "balls", "balls_sky", "bump_sphere", "bump_wall", "chess",
    "closed_box", "colonnade", "cornell_box", "cornell_horse", "disk_and_sphere", "egg_crate", "flying_dragon",
    "foliage_card", "fresnel_spheres", "frog", "gem", "gem_2_lights", "gem_4_lights", "glass_sphere",
    "glass_statue", "glassware", "glossy_furnace", "glossy_globe", "glossy_room", "glossy_sphere", "glossy_torus",
    "groove", "lights", "marble_statue", "measured_spheres", "metaballs", "milk", "monster", "nine_spheres",
    "nine_spheres_bump", "nine_spheres_glossy", "nine_spheres_metal", "patrol", "plant", "ring", "robot",
    "robot_brdfs", "smoke", "soda_corner", "soldiers", "stained_light", "statue", "teapot", "teapot_coarse",
    "teapot_groove", "teapot_pattern", "three_lights", "torus_metal", "translucent_checker", "translucent_ear",
    "translucent_edge",
    "translucent_head", "translucent_spheres", "water", "white_furnace"};
// clang-format on
const std::set<std::string> kUnderEnvironments = {
    "arcade_dark",        "balls_sky", "nine_spheres", "nine_spheres_bump", "nine_spheres_glossy",
    "nine_spheres_metal", "patrol",    "robot_brdfs",  "white_furnace"};

/// Of the scenes that are not lit by an environment.
std::size_t lightsOf(const std::string& scene) {
  const std::map<std::string, std::size_t> several = {
      {"disk_and_sphere", 3}, {"fresnel_spheres", 3}, {"gem_2_lights", 2},     {"gem_4_lights", 4},
      {"glossy_torus", 4},    {"lights", 5},          {"measured_spheres", 3}, {"teapot_groove", 2},
      {"three_lights", 3},    {"torus_metal", 5}};
  const auto found = several.find(scene);
  return found == several.end() ? 1 : found->second;
}

TEST(Assets, EveryMeshIsValid) {
  for (const char* scene : kScenes) {
    const Glb glb(scene);
    ASSERT_TRUE(glb.root.is_object()) << scene;
    for (const json& mesh : glb.root.at("meshes")) {
      SCOPED_TRACE(std::string(scene) + "/" + mesh["name"].get<std::string>());
      for (const json& primitive : mesh["primitives"]) {
        const json& attributes = primitive["attributes"];
        const auto positions = glb.read<Vec3>(attributes["POSITION"]);
        const auto normals = glb.read<Vec3>(attributes["NORMAL"]);
        ASSERT_EQ(positions.size(), normals.size());
        const json& bounds = glb.root["accessors"][attributes["POSITION"].get<std::size_t>()];
        std::size_t badNormals = 0, outside = 0, badIndices = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
          const Vec3& n = normals[i];
          badNormals += !(std::abs(std::hypot(n[0], n[1], n[2]) - 1) < 1e-4f);
          for (std::size_t k = 0; k < 3; ++k) {
            outside += !(positions[i][k] >= bounds["min"][k].get<float>() &&
                         positions[i][k] <= bounds["max"][k].get<float>());
          }
        }
        const auto indices = glb.indices(primitive);
        for (const std::uint32_t index : indices) badIndices += index >= positions.size();
        EXPECT_EQ(badNormals, 0u);
        EXPECT_EQ(outside, 0u);
        ASSERT_EQ(badIndices, 0u);
        EXPECT_EQ(indices.size() % 3, 0u);
        // The front side is where the normals point, for all but slivers at creases and poles.
        std::size_t against = 0;
        for (std::size_t i = 0; i < indices.size(); i += 3) {
          const Vec3 &a = positions[indices[i]], &b = positions[indices[i + 1]],
                     &c = positions[indices[i + 2]];
          const Vec3 e{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, f{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
          const Vec3 cross{e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
          float sum = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            sum +=
                cross[k] * (normals[indices[i]][k] + normals[indices[i + 1]][k] + normals[indices[i + 2]][k]);
          }
          against += sum < 0;
        }
        EXPECT_LE(against, indices.size() / 3 / 1000) << "triangles wound against their normals";
        if (attributes.contains("TANGENT")) {
          for (const Vec4& t : glb.read<Vec4>(attributes["TANGENT"])) {
            ASSERT_NEAR(std::hypot(t[0], t[1], t[2]), 1, 1e-4);
            ASSERT_EQ(std::abs(t[3]), 1);
          }
        }
      }
    }
  }
}

TEST(Assets, TriangleCountsAreAsPromised) {
  EXPECT_GE(Glb("plant").trianglesShown(), 100'000u);
  EXPECT_GE(Glb("atrium").trianglesShown(), 70'000u);
  EXPECT_GE(Glb("statue").trianglesShown(), 70'000u);
  EXPECT_GE(Glb("cornell_horse").trianglesShown(), 15'000u);
  EXPECT_LE(Glb("cornell_horse").trianglesShown(), 18'000u);
  EXPECT_GE(Glb("atrium_robots").trianglesShown(), 85'000u);
  EXPECT_LE(Glb("atrium_robots").trianglesShown(), 115'000u);
  EXPECT_GE(Glb("patrol").trianglesShown(), 1'000'000u);
  EXPECT_GE(Glb("soldiers").trianglesShown(), 9'000'000u);
  EXPECT_LE(Glb("soldiers").trianglesShown(), 13'000'000u);
}

TEST(Assets, EverySceneHasNamedCamerasAndTheLightsItNames) {
  for (const char* scene : kScenes) {
    const Glb glb(scene);
    std::set<std::string> names;
    bool lit = glb.root["scenes"][0].contains("extras");
    for (const json& node : glb.root["nodes"]) {
      if (node.contains("camera")) names.insert(node["name"].get<std::string>());
      if (node["name"] == "key") lit = true;
      if (node.contains("rotation")) {
        const Vec4 q = node["rotation"].get<Vec4>();
        EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-5);
      }
    }
    EXPECT_TRUE(names.count("main") && names.count("close")) << scene;
    EXPECT_TRUE(lit) << scene;
    for (const json& image : glb.root.value("images", json::array())) {
      EXPECT_TRUE(fs::exists(kAssets / scene / image["uri"].get<std::string>())) << scene << " " << image;
    }
  }
  for (const std::string& scene : kUnderEnvironments) {
    const json extras = Glb(scene).root["scenes"][0]["extras"];
    EXPECT_TRUE(fs::exists(kAssets / scene / extras["limn_environment"].get<std::string>())) << scene;
  }
}

TEST(Assets, TheSkyIsBrightInFewPlacesAndTakesAboutThirtyLights) {
  std::vector<std::string> warnings;
  const limn::scene::Environment sky =
      limn::scene::loadEnvironment(kAssets / "environments" / "sky.exr", warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(sky.width, 512);
  EXPECT_EQ(sky.height, 256);
  EXPECT_EQ(bytesOf(kAssets / "environments" / "sky.exr"),
            bytesOf(kAssets / "balls_sky" / "environment.exr"));
  const auto lights = limn::shading::decomposeEnvironment(sky, {.threshold = 0.015}).lights;
  EXPECT_GE(lights.size(), 25u);
  EXPECT_LE(lights.size(), 40u);
}

TEST(Assets, LightsHoldsOneOfEveryType) {
  const Glb glb("lights");
  std::map<std::string, int> types;
  for (const json& light : glb.root["extensions"]["KHR_lights_punctual"]["lights"]) ++types[light["type"]];
  int areas = 0, angles = 0, emissive = 0;
  for (const json& node : glb.root["nodes"]) {
    if (!node.contains("extras")) continue;
    areas += node["extras"].contains("limn_area");
    angles += node["extras"].contains("limn_angle");
  }
  for (const json& material : glb.root["materials"]) emissive += material.contains("emissiveFactor");
  EXPECT_EQ(types["point"], 2);  // one of them is the rectangle
  EXPECT_EQ(types["spot"], 1);
  EXPECT_EQ(types["directional"], 1);
  EXPECT_EQ(areas, 1);
  EXPECT_EQ(angles, 1);
  EXPECT_EQ(emissive, 1);
}

/// After `seconds` every node is where it was.
void expectLoops(const Glb& glb, float seconds) {
  for (const json& channel : glb.root["animations"][0]["channels"]) {
    const json& sampler = glb.root["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
    const auto times = glb.read<float>(sampler["input"]);
    EXPECT_NEAR(times.back() - times.front(), seconds, 1e-5);
    EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
    if (channel["target"]["path"] == "translation") {
      const auto values = glb.read<Vec3>(sampler["output"]);
      EXPECT_EQ(values.front(), values.back());
      continue;
    }
    const auto values = glb.read<Vec4>(sampler["output"]);
    const auto cosine = [](const Vec4& p, const Vec4& q) {
      return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
    };
    // q and -q are the same rotation
    EXPECT_NEAR(std::abs(cosine(values.front(), values.back())), 1, 1e-5);
    for (std::size_t k = 1; k < values.size(); ++k) EXPECT_GT(cosine(values[k - 1], values[k]), 0.9f);
  }
}

TEST(Assets, RobotIsSkinnedAndItsDanceLoops) {
  const Glb glb("robot");
  const json& skin = glb.root["skins"][0];
  const std::size_t joints = skin["joints"].size();
  EXPECT_GE(joints, 15u);
  std::size_t blended = 0;
  for (const json& mesh : glb.root["meshes"]) {
    for (const json& primitive : mesh["primitives"]) {
      if (!primitive["attributes"].contains("JOINTS_0")) continue;
      const auto weights = glb.read<Vec4>(primitive["attributes"]["WEIGHTS_0"]);
      const auto indices = glb.read<std::array<std::uint8_t, 4>>(primitive["attributes"]["JOINTS_0"]);
      for (std::size_t v = 0; v < weights.size(); ++v) {
        const Vec4& w = weights[v];
        ASSERT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 2e-7);
        for (std::size_t k = 0; k < 4; ++k) {
          ASSERT_GE(w[k], 0);
          ASSERT_LT(indices[v][k], joints);
        }
        blended += w[0] < 0.9f && w[1] < 0.9f;
      }
    }
  }
  EXPECT_GT(blended, 1000u);
  expectLoops(glb, 4);
}

/// Whether an animation moves a light.
bool lightMoves(const Glb& glb) {
  return std::ranges::any_of(glb.root["animations"][0]["channels"], [&](const json& channel) {
    return glb.root["nodes"][channel["target"]["node"].get<std::size_t>()]["name"] == "key";
  });
}

TEST(Assets, ScenesOfIndirectLightMoveTheirSpotAndLoop) {
  for (const auto& [scene, seconds] : {std::pair{"cornell_horse", 8.f}, {"atrium_robots", 4.f}}) {
    const Glb glb(scene);
    expectLoops(glb, seconds);
    EXPECT_TRUE(lightMoves(glb)) << scene;
  }
  EXPECT_EQ(Glb("atrium_robots").root["skins"].size(), 5u);
}

TEST(Assets, RobotsOfFourMaterialsTurnOnceInThreeDances) {
  const Glb glb("robot_brdfs");
  EXPECT_EQ(glb.root["skins"].size(), 4u);
  expectLoops(glb, 12);
}

TEST(Assets, MetaballsHaveAboutFiveThousandTrianglesInEveryFrame) {
  const limn::scene::Scene scene = limn::scene::load(kAssets / "metaballs" / "metaballs.glb");
  ASSERT_EQ(scene.dynamic.size(), 1u);
  for (int second = 0; second < 12; ++second) {
    const limn::scene::Pose pose = limn::scene::evaluate(scene, second);
    const std::size_t triangles = pose.dynamic[0].primitive->indices.size() / 3;
    EXPECT_GE(triangles, 3500u) << second;
    EXPECT_LE(triangles, 6500u) << second;
    const auto& [low, high] = pose.dynamic[0].bounds;
    EXPECT_GT(low.y, 0.02f) << "above the floor";
    EXPECT_LT(std::max({std::abs(low.x), high.x, high.z}), 0.98f) << "inside the walls";
  }
}

TEST(Assets, TheLoaderTakesEverySceneWithoutAWarning) {
  for (const char* name : kScenes) {
    SCOPED_TRACE(name);
    const limn::scene::Scene scene = limn::scene::load(kAssets / name / (std::string(name) + ".glb"));
    EXPECT_THAT(scene.warnings, testing::IsEmpty());
    EXPECT_EQ(scene.triangles(), Glb(name).trianglesShown());
    const limn::scene::Pose pose = limn::scene::evaluate(scene, 0.5);
    const bool sky = kUnderEnvironments.count(name) > 0;
    EXPECT_EQ(pose.lights.size(), sky ? 0u : lightsOf(name));
    if (!pose.lights.empty()) {
      EXPECT_THAT(pose.lightNames, testing::Contains("key"));
    }
    EXPECT_EQ(static_cast<bool>(scene.environment), sky);
  }
}

/// Every edge belongs to two triangles, in opposite directions.
void expectClosed(const Glb& glb, const json& mesh) {
  const auto indices = glb.indices(mesh["primitives"][0]);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // directed
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{indices[i + k], indices[i + (k + 1) % 3]}];
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) open += count != 1 || !edges.contains({edge.second, edge.first});
  EXPECT_EQ(open, 0u) << "of " << edges.size() << " of " << mesh["name"];
}

TEST(Assets, StatueAndHorseAreWatertight) {
  for (const auto& [scene, name] : {std::pair{"statue", "statue"}, {"cornell_horse", "horse"}}) {
    const Glb glb(scene);
    const auto mesh = std::ranges::find_if(glb.root["meshes"],
                                           [named = name](const json& m) { return m["name"] == named; });
    ASSERT_NE(mesh, glb.root["meshes"].end()) << name;
    expectClosed(glb, *mesh);
  }
}

TEST(Assets, TheGeneratorIsDeterministicAndRefusesUnknownNames) {
  const fs::path folder = fs::path(testing::TempDir()) / "limn_assets_test";
  fs::remove_all(folder);
  const std::string program = std::string(limn::test::kBinaryDir) + "/bin/limn-make-scenes ";
  ASSERT_EQ(std::system((program + folder.string() +
                         " atrium cornell_box disk_and_sphere robot teapot white_furnace > /dev/null")
                            .c_str()),
            0);
  int compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    EXPECT_EQ(bytesOf(entry.path()), bytesOf(kAssets / fs::relative(entry.path(), folder))) << entry.path();
    ++compared;
  }
  EXPECT_GE(compared, 6);
  const auto status = [&](const std::string& arguments) {
    const int result = std::system((program + arguments + " > /dev/null 2>&1").c_str());
    return WIFEXITED(result) ? WEXITSTATUS(result) : -1;
  };
  EXPECT_EQ(status(folder.string() + " no_such_scene"), 2);
  EXPECT_EQ(status("--folder"), 2);
  EXPECT_EQ(status("--help"), 0);
  EXPECT_FALSE(fs::exists("--folder") || fs::exists("--help"));
  fs::remove_all(folder);
}

/// Whoever has a file that is made again keeps the old one, and what cannot take its place leaves nothing
/// behind.
TEST(Assets, TheGeneratorReplacesFilesWhole) {
  const fs::path folder = fs::path(testing::TempDir()) / "limn_assets_whole_test";
  fs::remove_all(folder);
  fs::create_directories(folder / "environments");
  fs::create_directory(folder / "about.json");  // which ends the program before it makes the scenes
  std::ofstream(folder / "before") << "old";
  fs::create_hard_link(folder / "before", folder / "environments/sky.exr");
  const std::string program = std::string(limn::test::kBinaryDir) + "/bin/limn-make-scenes ";
  EXPECT_NE(std::system((program + folder.string() + " > /dev/null 2>&1").c_str()), 0);
  EXPECT_EQ(bytesOf(folder / "before"), "old");
  EXPECT_EQ(bytesOf(folder / "environments/sky.exr"), bytesOf(kAssets / "environments/sky.exr"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 3) << "environments, about.json, before";
  fs::remove_all(folder);
}

}  // namespace
