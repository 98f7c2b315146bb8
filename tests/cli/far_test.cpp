// What the command line says and writes of a scene far from the origin is counted from the file's origin.
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "tests/cli/channels.h"
#include "tests/cli/limn_program.h"
#include "tests/support/gltf_builder.h"

namespace limn::test {
namespace {

class FarFromTheOrigin : public testing::Test {
 protected:
  /// A floor of 2 x 2 m with its middle at (x, 2 x, -x), under a lamp.
  std::string scene(double x) const {
    GltfBuilder b;
    const int positions = b.vec3({{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}});
    const int normals = b.vec3(std::vector<glm::vec3>(4, {0, 1, 0}));
    const int floor =
        b.meshNode(b.mesh({{"POSITION", positions}, {"NORMAL", normals}}, b.indices({0, 1, 2, 0, 2, 3})));
    b.root["nodes"][static_cast<size_t>(floor)]["translation"] = {x, 2 * x, -x};
    b.light({{"type", "point"}, {"intensity", intensity}},
            {{"translation", {x + lamp.x, 2 * x + lamp.y, -x + lamp.z}}});
    const auto bytes = b.glb();
    const std::filesystem::path file = folder_ / "floor.glb";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
  }
  /// What limn writes when it is given the command, the scene at x and more arguments.
  Channels written(std::vector<std::string> command, double x, const std::vector<std::string>& more) const {
    const std::filesystem::path out = folder_ / "out.exr";
    std::filesystem::remove(out);
    command.push_back(scene(x));
    command.insert(command.end(), more.begin(), more.end());
    command.insert(command.end(), {"--out", out.string()});
    const Outcome outcome = limn(command);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Channels(out);
  }
  /// Mean absolute difference over the mean of `a`.
  static double difference(const Channels& a, const Channels& b) {
    double error = 0, sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      error += std::abs(double(a.at(i, "G")) - double(b.at(i, "G")));
      sum += double(a.at(i, "G"));
    }
    EXPECT_GT(sum, 0);
    return error / sum;
  }
  static std::string place(double x, const glm::dvec3& p) {
    std::ostringstream text;
    text << std::setprecision(17) << x + p.x << ',' << 2 * x + p.y << ',' << -x + p.z;
    return text.str();
  }

  static constexpr double intensity = 2;
  static constexpr glm::dvec3 lamp{0.25, 1, 0};
  const TemporaryFolder folder_;
};

TEST_F(FarFromTheOrigin, EyeAndTargetLieInTheWorldOfTheFile) {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"render", "--technique", "hard_shadow_map,airlight"},
        std::vector<std::string>{"reference", "--term", "final", "--spp", "8"}}) {
    SCOPED_TRACE(command.front());
    const auto from = [&](double x) {
      return written(command, x,
                     {"--eye", place(x, {0.375, 1.25, 2.125}), "--target", place(x, {0.125, 0, -0.25}),
                      "--size", "32x32", "--sigma-s", "0.2", "--sigma-a", "0.1"});
    };
    const Channels near = from(0);
    for (const double x : {1e5, 1e7}) EXPECT_LT(difference(near, from(x)), 5e-3) << x;
  }
}

TEST_F(FarFromTheOrigin, VerticesLieInTheWorldOfTheFile) {
  for (const double x : {0.0, 1e5, 1e7}) {
    SCOPED_TRACE(x);
    const Channels list = written({"reference", "--at-vertices", "--term", "direct", "--spp", "8"}, x,
                                  {"--longest-edge", "0.5"});
    EXPECT_EQ(list.has("P.rest.X"), x != 0);
    size_t points = 0;
    for (size_t i = 0; i < list.size(); ++i) {
      if (list.at(i, "coverage") == 0) continue;
      ++points;
      const auto along = [&](const std::string& axis) {
        return double(list.at(i, "P." + axis)) + (x != 0 ? double(list.at(i, "P.rest." + axis)) : 0);
      };
      const glm::dvec3 p(along("X") - x, along("Y") - 2 * x, along("Z") + x);
      EXPECT_NEAR(p.y, 0, 1e-5);
      const double irradiance = intensity * lamp.y / std::pow(glm::length(lamp - p), 3);
      EXPECT_NEAR(double(list.at(i, "R")) / irradiance, 1, 2e-3) << p.x << ", " << p.z;
    }
    EXPECT_GT(points, 8u);
  }
}

}  // namespace
}  // namespace limn::test
