// limn reference --at-vertices: irradiance of the points that methods light which light vertices.
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>

#include "tests/cli/channels.h"
#include "tests/cli/limn_program.h"
#include "tests/support/gltf_builder.h"

namespace limn::test {
namespace {

class Vertices : public testing::Test {
 protected:
  /// A floor of 2 x 2 m at y = 0 under a rectangle of 0.6 x 0.4 m that faces it from `height`.
  Vertices() {
    GltfBuilder b;
    const int positions = b.vec3({{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}});
    const int normals = b.vec3(std::vector<glm::vec3>(4, {0, 1, 0}));
    b.meshNode(b.mesh({{"POSITION", positions}, {"NORMAL", normals}}, b.indices({0, 1, 2, 0, 2, 3})));
    const float half =
        glm::one_over_root_two<float>();  // a quarter turn about x: -z becomes -y, y becomes -z
    b.light({{"type", "point"}, {"intensity", 2}}, {{"translation", {0, height, 0}},
                                                    {"rotation", {-half, 0, 0, half}},
                                                    {"extras", {{"limn_area", {2 * half_x, 2 * half_z}}}}});
    const auto bytes = b.glb();
    std::ofstream(scene_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  Outcome reference(std::vector<std::string> more, const std::string& term = "direct") const {
    std::vector<std::string> all{"reference", scene_, "--at-vertices", "--term", term};
    all.insert(all.end(), more.begin(), more.end());
    return limn(all);
  }

  /// Of a point of the floor by a parallel rectangle of radiance 1 from (0, 0) to (x, z), signed (Howell, A
  /// Catalog of Radiation Heat Transfer Configuration Factors, B-3).
  static double corner(double x, double z) {
    const double a = x / height, b = z / height, p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return 0.5 * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
  }
  static double irradiance(double x, double z) {
    const double radiance = 2 / (4 * half_x * half_z);
    return radiance * (corner(half_x - x, half_z - z) - corner(-half_x - x, half_z - z) -
                       corner(half_x - x, -half_z - z) + corner(-half_x - x, -half_z - z));
  }

  static constexpr double height = 0.8, half_x = 0.3, half_z = 0.2;
  const TemporaryFolder folder_;
  const std::filesystem::path scene_ = folder_ / "floor.glb", out_ = folder_ / "vertices.exr";
};

TEST_F(Vertices, OfAFloorUnderARectangleHaveItsIrradiance) {
  const Outcome outcome = reference({"--longest-edge", "0.2", "--spp", "1024", "--out", out_.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("1024 samples each"));
  EXPECT_THAT(outcome.err, testing::HasSubstr("reference: 100% 1024 spp"));
  const Channels list(out_);
  size_t points = 0;
  double sum = 0, exact = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    if (list.at(i, "coverage") == 0) continue;
    ++points;
    EXPECT_NEAR(list.at(i, "N.Y"), 1, 1e-5);
    EXPECT_NEAR(list.at(i, "P.Y"), 0, 1e-5);
    const double here = irradiance(list.at(i, "P.X"), list.at(i, "P.Z"));
    EXPECT_NEAR(list.at(i, "R") / here, 1, 0.05) << list.at(i, "P.X") << ", " << list.at(i, "P.Z");
    sum += list.at(i, "R");
    exact += here;
  }
  EXPECT_GT(points, 60u) << "edges of 2 m are halved";
  EXPECT_NEAR(sum / exact, 1, 0.003);
}

TEST_F(Vertices, RefuseWhatTheyCannotShow) {
  expectRefused(reference({"--out", (folder_ / "vertices.png").string()}), 2, {"--at-vertices", ".exr"});
  const auto refused = [&](const std::string& term, std::vector<std::string> more,
                           const std::vector<std::string>& parts) {
    more.insert(more.end(), {"--out", out_.string()});
    expectRefused(reference(more, term), 2, parts);
    EXPECT_FALSE(std::filesystem::exists(out_));
  };
  refused("visibility", {}, {"at vertices", "final, direct and indirect"});
  refused("direct", {"--longest-edge", "0.001"}, {"--longest-edge", "0.005"});
  refused("direct", {"--bounces", "3"}, {"bounces 3", "direct", "have bounces"});
  refused("indirect", {"--bounces", "0"}, {"bounces 0", "1 .. 1024"});
  refused("direct", {"--relief-paths", "relief"}, {"relief paths 'relief'", "direct"});
  refused("direct", {"--subsurface", "walk"}, {"subsurface 'walk'", "direct"});
  refused("direct", {"--interfaces", "all"}, {"interfaces", "direct"});
}

TEST_F(Vertices, ShowProgressUnlessQuiet) {
  const Outcome spoken = reference({"--spp", "16", "--out", out_.string()});
  ASSERT_EQ(spoken.status, 0) << spoken.err;
  EXPECT_THAT(spoken.err, testing::StartsWith("reference: "));
  EXPECT_EQ(reference({"--spp", "16", "--quiet", "--out", out_.string()}).err, "");
}

}  // namespace
}  // namespace limn::test
