// Techniques that project shadow-map texels back onto the light, against closed forms: a square light of 1 m,
// 4 m above a floor, and quads parallel to both.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

class BackprojectionTest : public TechniqueTest {
 protected:
  BackprojectionTest() {
    addMesh(scene_, floorPrimitive(2.5f, addMaterial(scene_)));
    addInstance(scene_, pose_, 0);
    addLight(pose_, rectangleLight({0, 4, 0}, {0, -1, 0}, 1, 1));
  }

  /// A square of 2 `half` at `centre`, parallel to the floor.
  void block(const vec3& centre, float half) {
    const int mesh = addMesh(scene_, floorPrimitive(half, 0));
    addInstance(scene_, pose_, mesh, at(centre.x, centre.y, centre.z));
  }

  /// Techniques of this kind that are installed.
  static std::vector<std::string> names() {
    std::vector<std::string> found;
    for (const TechniquePlugin* plugin : registry().all()) {
      if (std::string_view(plugin->info->name) == "backprojection" ||
          std::string_view(plugin->info->name) == "bitmask_soft_shadows")
        found.emplace_back(plugin->info->name);
    }
    return found;
  }

  Answer answer(const std::string& name, std::map<std::string, std::string> settings = {}) {
    settings.try_emplace("shadow_map_size", "512");
    if (name == "bitmask_soft_shadows") settings.try_emplace("sample_points", "256");
    return visibility(name, settings, scene_, pose_, camera_);
  }

  /// Calls visit(x, z, V) for the floor points with |x|, |z| < reach.
  int forFloor(const Answer& v, float reach, const std::function<void(float, float, float)>& visit) const {
    glsl::FrameBlock frame{};
    scene::setCamera(frame, camera_, pose_.bounds, v.width, v.height);
    int visited = 0;
    for (int y = 0; y < v.height; ++y) {
      for (int x = 0; x < v.width; ++x) {
        const size_t i = static_cast<size_t>(y * v.width + x);
        if (v.instance[i] != 0) continue;
        const vec3 p =
            vec3(frame.camera_position) +
            v.depth[i] * (vec3(frame.view_ray_origin) + static_cast<float>(x) * vec3(frame.view_ray_dx) +
                          static_cast<float>(y) * vec3(frame.view_ray_dy));
        if (std::max(std::abs(p.x), std::abs(p.z)) >= reach) continue;
        ++visited;
        visit(p.x, p.z, v.lights[0][i]);
      }
    }
    return visited;
  }

  scene::Scene scene_;
  scene::Pose pose_;
  scene::CameraPose camera_ = scene::lookAt({0, 0.9f, 3}, {0, 0, 0}, 0.5f);  // below all blockers
};

/// An edge over x = 0 half-way up: the point x sees it at -x on the light.
TEST_F(BackprojectionTest, StraightEdgesHideTheirShareOfTheLight) {
  block({1, 2, 0}, 1);
  for (const std::string& name : names()) {
    const Answer v = answer(name);
    double at0 = 0;
    int count = 0;
    const int visited = forFloor(v, 0.4f, [&](float x, float, float seen) {
      EXPECT_NEAR(seen, 0.5f - x, 0.03f) << name << " at " << x;
      if (std::abs(x) > 0.02f) return;
      at0 += seen;
      ++count;
    });
    EXPECT_GT(visited, 1000);
    EXPECT_NEAR(at0 / count, 0.5, 0.01) << name;
  }
}

TEST_F(BackprojectionTest, AQuadHidesItsOwnAreaOfTheLight) {
  constexpr float half = 0.15f;
  block({0, 2, 0}, half);
  const auto hidden = [](float x) {  // [-2 half - x, 2 half - x] on the light
    return std::max(std::min(2 * half - x, 0.5f) - std::max(-2 * half - x, -0.5f), 0.f);
  };
  for (const std::string& name : names()) {
    double difference = 0;
    const int visited = forFloor(answer(name), 1, [&](float x, float z, float seen) {
      const float expected = 1 - hidden(x) * hidden(z);
      EXPECT_NEAR(seen, expected, 0.04f) << name << " at " << x << ", " << z;
      difference += seen - expected;
    });
    EXPECT_GT(visited, 2000);
    EXPECT_NEAR(difference / visited, 0, 0.008) << name;  // the quad is some 30 texels wide
  }
}

TEST_F(BackprojectionTest, WithoutBlockersAllIsLitAndBehindAWallNothing) {
  for (const std::string& name : names()) {
    const Answer open = answer(name);
    EXPECT_EQ(*std::ranges::min_element(open.lights[0]), 1.f) << name;
  }
  block({0, 1.5f, 0}, 1.5f);
  for (const std::string& name : names()) {
    const int visited =
        forFloor(answer(name), 1, [&](float x, float, float seen) { EXPECT_EQ(seen, 0.f) << name << x; });
    EXPECT_GT(visited, 2000);
  }
}

/// Two edges above each other; what the map sees of the lower one overlaps the upper one for some points,
/// lies beside it with a gap between for others.
TEST_F(BackprojectionTest, OverlappingBlockersCountOnceAndGapsAreClosed) {
  block({1, 2, 0}, 1);
  block({0.9f, 1, 0}, 1);
  for (const std::string& name : names()) {
    const int visited = forFloor(answer(name), 0.35f, [&](float x, float, float seen) {
      const float expected = std::clamp(std::min(-x, -0.4f - 3 * x) + 0.5f, 0.f, 1.f);
      EXPECT_LT(seen, expected + 0.05f) << name << " at " << x;
      // Sums count what both edges hide twice, but for the texels where they meet.
      const float twice = name == "backprojection" ? 0.25f : 0.05f;
      EXPECT_GT(seen, expected - twice) << name << " at " << x;
    });
    EXPECT_GT(visited, 500);
  }
}

TEST_F(BackprojectionTest, ExtremeLightsMapsAndContacts) {
  const int ball = addMesh(scene_, spherePrimitive(0.4f, 0, 24));
  addInstance(scene_, pose_, ball, at(0, 0.4f, 0));
  block({0.8f, 1e-6f, 0}, 0.3f);
  addLight(pose_, rectangleLight({2, 0.4f, 0}, {-1, 0, 0}, 0.4f, 0.4f));  // seen edge-on
  addLight(pose_, directionalLight({1, -0.01f, 0}, 0.3f));
  addLight(pose_, pointLight({0, 0.05f, 1.5f}));
  for (const std::string& name : names()) {
    for (const char* size : {"64", "100", "1024"}) {
      for (const char* light : {"-1", "1e-4", "100"}) {
        const Answer v = answer(name, {{"shadow_map_size", size}, {"light_size", light}, {"patches", "16"}});
        for (const std::vector<float>& layer : v.lights) {
          const auto [least, most] = std::ranges::minmax(layer);
          EXPECT_GE(least, 0.f);
          EXPECT_EQ(most, 1.f) << name << " " << size << " " << light;
        }
      }
    }
  }
}

TEST_F(BackprojectionTest, LargeMaps) {
  block({1, 2, 0}, 1);
  for (const std::string& name : names()) {
    const int visited = forFloor(
        answer(name, {{"shadow_map_size", "4096"}}), 0.4f,
        [&](float x, float, float seen) { EXPECT_NEAR(seen, 0.5f - x, 0.03f) << name << " at " << x; });
    EXPECT_GT(visited, 1000);
  }
}

/// The kernels of an edge under a light of 2 m are 819 texels wide: walked texel by texel by a thread of
/// llvmpipe, which leaves all of its loops after 65,535 steps, they would lose their last rows, up to 0.09 of
/// V. 256 sample points err by 0.033.
TEST_F(BackprojectionTest, WideKernelsAreWalkedToTheirEnd) {
  drawn = 16;
  camera_ = scene::lookAt({0, 0.9f, 3}, {0, 0, 0}, 0.1f);
  block({0.6f, 2, 0}, 0.6f);
  for (const std::string& name : names()) {
    const int visited =
        forFloor(answer(name, {{"shadow_map_size", "2048"}, {"light_size", "2"}, {"patches", "1024"}}), 0.15f,
                 [&](float x, float, float seen) {
                   EXPECT_NEAR(seen, 0.5f - 0.5f * x, 0.045f) << name << " at " << x;
                 });
    EXPECT_GT(visited, 30) << name;
  }
}

/// Fewer patches cost accuracy, not the picture.
TEST_F(BackprojectionTest, PatchesConverge) {
  block({0.7f, 2, 0}, 0.5f);
  for (const std::string& name : names()) {
    const Answer many = answer(name, {{"patches", "512"}});
    double former = 0.2;
    for (const char* patches : {"4", "16", "64"}) {
      const Answer few = answer(name, {{"patches", patches}});
      double squares = 0;
      for (size_t i = 0; i < few.lights[0].size(); ++i)
        squares += std::pow(double{few.lights[0][i]} - many.lights[0][i], 2);
      const double rms = std::sqrt(squares / static_cast<double>(few.lights[0].size()));
      EXPECT_LE(rms, former) << name << " " << patches;
      former = rms;
    }
    EXPECT_LT(former, 0.01) << name;
  }
}

}  // namespace
}  // namespace limn
