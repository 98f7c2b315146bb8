// Moment soft shadow maps and percentage-closer filtering: their tables against sums, and answers that are
// known.
#include "glsl/shadow/moment_shadow.glsl"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <random>

#include "core/base/error.h"
#include "core/shadow/derived_maps.h"
#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

class MomentTableTest : public GlTest {
 protected:
  /// A table of random depths (0 and 1 among them) and what it must hold.
  void compare(int width, int height, int layers, int bits, bool shared) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(-0.1f, 1.1f);
    const auto w = static_cast<size_t>(width), h = static_cast<size_t>(height);
    std::vector<float> depths(w * h * static_cast<size_t>(layers));
    for (float& z : depths) z = std::clamp(value(random), 0.f, 1.f);
    gpu::Texture source(device(), "source",
                        {.target = GL_TEXTURE_2D_ARRAY,
                         .format = GL_R32F,
                         .width = width,
                         .height = height,
                         .layers = layers});
    for (int i = 0; i < layers; ++i)
      source.upload(0, i, GL_RED, GL_FLOAT, depths.data() + static_cast<size_t>(i) * w * h);

    frame::ResourcePool pool(device());
    frame::FrameGraph graph;
    const shadow::MomentTable table =
        shadow::addMomentTable(graph, graph.importTexture("source", source), false, bits, shared);
    graph.output(table.texture);
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    std::vector<glm::uvec4> actual(depths.size());
    graph.texture(table.texture)
        .read(0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, actual.data(), actual.size() * sizeof(glm::uvec4));

    size_t i = 0, wrong = 0;
    for (int layer = 0; layer < layers; ++layer) {
      std::vector<glm::uvec4> above(w, glm::uvec4(0u));
      for (uint32_t y = 0; y < h; ++y) {
        glm::uvec4 row(0u);
        for (uint32_t x = 0; x < w; ++x, ++i) {
          row += glsl::moment_texel(depths[i], {x, y}, bits);
          above[x] += row;
          if (actual[i] != above[x]) ++wrong;
        }
      }
    }
    EXPECT_EQ(wrong, 0u) << width << " x " << height << ", " << bits << " bits, shared " << shared;
  }
};

TEST_F(MomentTableTest, SumsAreExactToTheBitByBothMethods) {
  for (const bool shared : {false, true}) {
    for (const int bits : {10, 14, 20}) {
      compare(64, 64, 3, bits, shared);
      compare(257, 100, 2, bits, shared);
      compare(1, 1, 1, bits, shared);
    }
  }
}

TEST_F(MomentTableTest, BitsFollowTheMapAndOthersAreRefused) {
  EXPECT_EQ(shadow::momentBits(64), 20);
  EXPECT_EQ(shadow::momentBits(1024), 18);
  EXPECT_EQ(shadow::momentBits(4096), 14);
  EXPECT_EQ(shadow::momentBits(16384), 14);
  EXPECT_THROW(compare(4, 4, 1, 9, false), UsageError);
  EXPECT_THROW(compare(4, 4, 1, 21, false), UsageError);
}

/// A floor under a square blocker of side 1 at `height`, seen from above, lit by a rectangle at height 4.
struct PlanesScene {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera;

  explicit PlanesScene(float height, float half = 0.5f, float light = 0.6f) {
    addMesh(scene, floorPrimitive(4, addMaterial(scene)));
    addMesh(scene, floorPrimitive(half, 0));
    addInstance(scene, pose, 0);
    addInstance(scene, pose, 1, at(0, height, 0));
    addLight(pose, rectangleLight({0, 4, 0}, {0, -1, 0}, light, light));
    addLight(pose, directionalLight({0.1f, -1, 0.2f}, 0.2f));
    camera = scene::lookAt({0, 1.2f, 5}, {0, 0, 0}, 0.9f);
  }
};

class MomentSoftShadowMapTest : public TechniqueTest {
 protected:
  static constexpr const char* name = "moment_soft_shadow_map";

  static void inRange(const Answer& v) {
    for (const auto& light : v.lights) {
      for (const float value : light) ASSERT_TRUE(value >= 0 && value <= 1) << value;
    }
  }
};

TEST_F(MomentSoftShadowMapTest, FloorsAreFullyLitOrFullyBlocked) {
  for (const char* technique : {name, "pcf"}) {
    const PlanesScene lit(-1);  // the square is below the floor
    for (const auto& light : visibility(technique, {}, lit.scene, lit.pose, lit.camera).lights)
      EXPECT_EQ(*std::ranges::min_element(light), 1.f) << technique;
    const PlanesScene blocked(2, 4);
    const Answer v = visibility(technique, {}, blocked.scene, blocked.pose, blocked.camera, {0});
    int floor = 0;
    for (size_t i = 0; i < v.instance.size(); ++i) {
      if (v.instance[i] != 0) continue;
      ++floor;
      ASSERT_EQ(v.lights[0][i], 0.f) << technique;
    }
    EXPECT_GT(floor, 1000) << technique;
  }
}

/// Planar, parallel light, blocker and receiver: percentage-closer soft shadows are exact, and so are
/// moments.
TEST_F(MomentSoftShadowMapTest, ParallelPlanesAreExact) {
  const PlanesScene s(1);
  for (const char* cells : {"1", "3"}) {
    const Answer v = visibility(name, {{"cells", cells}}, s.scene, s.pose, s.camera, {0});
    inRange(v);
    glsl::FrameBlock frame{};
    scene::setCamera(frame, s.camera, s.pose.bounds, side, side);
    double squares = 0, worst = 0;
    int penumbra = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto i = static_cast<size_t>(y * side + x);
        if (v.instance[i] != 0) continue;
        const vec3 p =
            vec3(frame.camera_position) +
            v.depth[i] * (vec3(frame.view_ray_origin) + static_cast<float>(x) * vec3(frame.view_ray_dx) +
                          static_cast<float>(y) * vec3(frame.view_ray_dy));
        // The light seen through height 1 is a square of side 0.15 around 3/4 p; the share of it over the
        // blocker hides.
        const auto covered = [](float c) {
          return std::max(0.f, std::min(0.5f, 0.75f * c + 0.075f) - std::max(-0.5f, 0.75f * c - 0.075f)) /
                 0.15f;
        };
        const double exact = 1 - double{covered(p.x)} * covered(p.z), error = v.lights[0][i] - exact;
        if (exact == 1 && error == 0) continue;
        squares += error * error;
        worst = std::max(worst, std::abs(error));
        ++penumbra;
      }
    }
    EXPECT_GT(penumbra, 150);
    EXPECT_LT(std::sqrt(squares / penumbra), 0.02) << cells;
    EXPECT_LT(worst, 0.1) << cells;
  }
}

/// The kernel of a narrow light is 0.6 texels wide where the square is. Searched in the cone alone, it is
/// widened to 1.6, of which half a texel in area counts as blockers: what is hidden of the texel that is
/// filtered is at most 0.2 where fewer are there.
TEST_F(MomentSoftShadowMapTest, NarrowLightsKeepTheirEdgesWhereTheConeAloneIsSearched) {
  PlanesScene s(1, 0.5f, 0.25f);
  s.camera = scene::lookAt({0, 0.9f, 1.8f}, {0, 0, 0}, 0.9f);
  for (const bool ofBound : {false, true}) {
    bound = ofBound;
    const auto draw = [&](const char* blur) {
      return visibility(name, {{"search_blur", blur}, {"shadow_map_size", "64"}}, s.scene, s.pose, s.camera,
                        {0});
    };
    const Answer cone = draw("0"), wide = draw("4");
    int edge = 0;
    float worst = 0;
    for (size_t i = 0; i < wide.instance.size(); ++i) {
      if (wide.instance[i] != 0) continue;
      edge += wide.lights[0][i] > 0.02f && wide.lights[0][i] < 0.98f;
      worst = std::max(worst, std::abs(cone.lights[0][i] - wide.lights[0][i]));
    }
    EXPECT_GT(edge, 300) << "bound " << ofBound;
    EXPECT_LT(worst, 0.25f) << "bound " << ofBound;
  }
}

/// A room of 4 x 3 x 4 m around a lamp of 0.6 m that hangs 0.1 m below the ceiling, with or without a table.
struct RoomScene {
  static constexpr float lampHeight = 2.9f, lampSide = 0.6f, tableHeight = 0.75f, tableSide = 1;
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera;

  explicit RoomScene(bool table) {
    const int wall = addMesh(scene, floorPrimitive(2, addMaterial(scene)));
    addInstance(scene, pose, wall);
    addInstance(scene, pose, wall,
                glm::translate(glm::mat4(1), {0, 3, 0}) * glm::rotate(glm::mat4(1), glsl::pi, vec3(1, 0, 0)));
    for (int i = 0; i < 4; ++i) {
      const glm::mat4 turn =
          glm::rotate(glm::mat4(1), 0.5f * glsl::pi * static_cast<float>(i), vec3(0, 1, 0));
      const glm::mat4 upright = glm::rotate(glm::mat4(1), 0.5f * glsl::pi, vec3(0, 0, 1));
      addInstance(scene, pose, wall, turn * glm::translate(glm::mat4(1), {2, 1, 0}) * upright);
    }
    if (table) {
      addInstance(scene, pose, addMesh(scene, floorPrimitive(0.5f * tableSide, 0)), at(0, tableHeight, 0));
    }
    addLight(pose, rectangleLight({0, lampHeight, 0}, {0, -1, 0}, lampSide, lampSide));
    camera = scene::lookAt({1.5f, 1.6f, 1.8f}, {-0.4f, 0.8f, -0.5f}, 1.3f);
  }
  /// The share of the lamp that a point of the floor sees past the table: of the lamp scaled down to the
  /// table's height, the part beside it.
  static double floorSees(const vec3& p) {
    const float share = tableHeight / lampHeight, reach = 0.5f * share * lampSide, edge = 0.5f * tableSide;
    const auto covered = [&](float c) {
      const float middle = (1 - share) * c;
      return double{std::max(0.f, std::min(edge, middle + reach) - std::max(-edge, middle - reach))} /
             (2 * reach);
    };
    return 1 - covered(p.x) * covered(p.z);
  }
};

/// Of a room without anything in it every point sees all of the lamp. From the lamp's centre walls and floor
/// fill whole search kernels, so whoever takes all of a kernel for blockers darkens them.
TEST_F(MomentSoftShadowMapTest, NothingShadowsAnEmptyRoom) {
  const RoomScene s(false);
  const Answer v = visibility(name, {}, s.scene, s.pose, s.camera);
  EXPECT_GE(*std::ranges::min_element(v.lights[0]), 0.99f);
}

TEST_F(MomentSoftShadowMapTest, ATableShadowsTheFloorAloneUnderALampNearTheCeiling) {
  const RoomScene s(true);
  const Answer v = visibility(name, {}, s.scene, s.pose, s.camera);
  glsl::FrameBlock frame{};
  scene::setCamera(frame, s.camera, s.pose.bounds, side, side);
  double dark = 0, squares = 0;
  int lit = 0, umbra = 0, penumbra = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto i = static_cast<size_t>(y * side + x);
      const vec3 p =
          vec3(frame.camera_position) +
          v.depth[i] * (vec3(frame.view_ray_origin) + static_cast<float>(x) * vec3(frame.view_ray_dx) +
                        static_cast<float>(y) * vec3(frame.view_ray_dy));
      const double exact = v.instance[i] == 0 ? RoomScene::floorSees(p) : 1, seen = v.lights[0][i];
      if (exact == 1) {
        dark += 1 - seen;
        ++lit;
      } else if (exact == 0) {
        EXPECT_LT(seen, 0.02) << x << "," << y;
        ++umbra;
      } else {
        squares += (seen - exact) * (seen - exact);
        ++penumbra;
      }
    }
  }
  EXPECT_GT(lit, 8000);
  EXPECT_GT(umbra, 300);
  EXPECT_GT(penumbra, 300);
  EXPECT_LT(dark / lit, 0.001);
  EXPECT_LT(std::sqrt(squares / penumbra), 0.05);
}

/// What no table has is refused with the other values that are not accepted, before anything is drawn.
TEST_F(MomentSoftShadowMapTest, BitsOfNoTableAreRefusedWhereTheyAreSet) {
  ParameterValues values(name, registry().find(name).info->parameters);
  for (const char* bits : {"1", "9", "21", "-1"})
    EXPECT_THAT(errorOf([&] { values.set("moment_bits", bits); }),
                testing::AllOf(testing::HasSubstr(fmt::format("moment_bits: '{}' is not accepted", bits)),
                               testing::HasSubstr("expected 0, 10, 11"), testing::EndsWith("19 or 20")));
  for (const char* bits : {"0", "10", "18", "20"}) EXPECT_NO_THROW(values.set("moment_bits", bits)) << bits;
}

TEST_F(MomentSoftShadowMapTest, ExtremesGiveVisibilitiesInRange) {
  const PlanesScene contact(1e-6f), edge(0.5f);
  for (const char* technique : {name, "pcf"}) {
    for (const char* size : {"1e-6", "1", "100"}) {
      for (const char* texels : {"16", "64", "1024"}) {
        inRange(visibility(technique, {{"light_size", size}, {"shadow_map_size", texels}}, edge.scene,
                           edge.pose, edge.camera));
      }
      inRange(visibility(technique, {{"light_size", size}}, contact.scene, contact.pose, contact.camera));
    }
  }
  // Kernels of many exact boxes; a receiver seen edge-on; a floor nearer to the light than the near plane,
  // which is at 1e-4 of the far one.
  inRange(visibility(name, {{"light_size", "100"}, {"shadow_map_size", "4096"}}, edge.scene, edge.pose,
                     edge.camera, {0}));
  inRange(
      visibility(name, {{"moment_bits", "20"}, {"light_size", "100"}}, edge.scene, edge.pose, edge.camera));
  PlanesScene grazing(0.5f);
  addLight(grazing.pose, rectangleLight({6, 1e-4f, 0}, {-1, 0, 0}, 0.5f, 0.5f));
  addLight(grazing.pose, rectangleLight({0, 1e-5f, 0}, {0, -1, 0}, 2e-5f, 2e-5f));
  inRange(visibility(name, {}, grazing.scene, grazing.pose, grazing.camera));
}

}  // namespace
}  // namespace limn
