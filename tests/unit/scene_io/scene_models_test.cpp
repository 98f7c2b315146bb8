// Models that are not limn's load whole, and move within their bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/scene_io/load.h"

namespace limn::scene {
namespace {

TEST(SceneModels, RealFiles) {
  const char* folder = std::getenv("LIMN_MODELS");
  if (!folder) GTEST_SKIP() << "LIMN_MODELS names no folder of glTF models";
  const std::map<std::string, std::uint64_t> triangles = {{"AnimatedMorphSphere.glb", 960},
                                                          {"CesiumMan.glb", 4672},
                                                          {"Fox.glb", 576},
                                                          {"LeePerrySmith.glb", 17684},
                                                          {"MorphStressTest.glb", 2412},
                                                          {"RobotExpressive.glb", 3237},
                                                          {"ShaderBall_88k.glb", 88264},
                                                          {"armadillo_86k.glb", 86482},
                                                          {"buddha_100k.glb", 100000},
                                                          {"bunny_69k.glb", 69451},
                                                          {"dragon_202k.glb", 199626},
                                                          {"dragon_871k.glb", 871414},
                                                          {"emerald.glb", 140},
                                                          {"sponza_262k.glb", 262267}};
  int loaded = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Scene scene = load(entry.path());
    ++loaded;
    if (const auto known = triangles.find(entry.path().filename().string()); known != triangles.end()) {
      EXPECT_EQ(scene.triangles(), known->second);
    }
    for (const Mesh& mesh : scene.meshes) {
      for (const Primitive& p : mesh.primitives) {
        double worst = 0;
        for (const glm::vec3& n : p.normals)
          worst = std::max(worst, std::abs(glm::length(glm::dvec3(n)) - 1));
        for (const glm::vec4& t : p.tangents)
          worst = std::max(worst, std::abs(glm::length(glm::dvec3(glm::vec3(t))) - 1));
        EXPECT_LT(worst, 1e-5);
        EXPECT_EQ(p.normals.size(), p.positions.size());
        EXPECT_TRUE(std::isfinite(p.bounds.radius()));
      }
    }
    const Pose pose = evaluate(scene, 0.4);
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
    for (const Deformation& d : pose.deformed) {
      deform(scene.meshes[static_cast<std::size_t>(d.mesh)].primitives[static_cast<std::size_t>(d.primitive)],
             d, positions, normals, tangents);
      for (const glm::vec3& n : normals) ASSERT_NEAR(glm::length(n), 1, 1e-4);
      if (d.joints.empty()) continue;
      const glm::vec3 slack(1e-3f * pose.bounds.radius());
      for (const glm::vec3& p : positions) {
        ASSERT_TRUE(glm::all(glm::lessThanEqual(pose.bounds.low, p + slack)));
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(pose.bounds.high, p - slack)));
      }
    }
  }
  EXPECT_GT(loaded, 0);
}

}  // namespace
}  // namespace limn::scene
