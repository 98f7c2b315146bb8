// Subtractive shadows over time: levels of detail, and a camera that moves.
#include <gmock/gmock.h>

#include "tests/gpu/subtractive_harness.h"

namespace limn {
namespace {

using glm::vec3;

class SubtractiveLevelsTest : public SubtractiveShadowsTest {};

/// A budget that no frame keeps leads from the best level to the least one.
TEST_F(SubtractiveLevelsTest, LevelsBeginAtTheBestAndEndAtTheLeast) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const auto with = [&](const char* lights, const char* time) {
    return settings(64, 48, Term::direct,
                    {shadows({{"shadow_map_size", "64"},
                              {"combine", "ratio"},
                              {"block", "32"},
                              {"lights", lights},
                              {"frame_time", time}})});
  };
  const Image best = picture(renderer, with("40", "0")), least = picture(renderer, with("8", "0"));
  renderer.configure(with("40", "0.001"));
  renderer.render();
  EXPECT_LT(rmse(renderer.read(), best), 1e-6);
  for (int frame = 1; frame < 60; ++frame) renderer.render();
  EXPECT_LT(rmse(renderer.read(), least), 1e-6);
}

/// The clock between the starts of frames that fail says nothing of what a frame takes.
TEST_F(SubtractiveLevelsTest, FramesThatFailLeaveTheLevelAlone) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const auto with = [&](const char* time) {
    return settings(64, 48, Term::direct,
                    {shadows({{"shadow_map_size", "64"},
                              {"combine", "ratio"},
                              {"block", "32"},
                              {"lights", "40"},
                              {"frame_time", time}})});
  };
  const Image best = picture(renderer, with("0"));
  renderer.configure(with("0.001"));
  renderer.render();
  const auto fails = []() -> bool { throw Error("it fails"); };
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(errorOf([&] { renderer.render(frame::Timing::off, fails); }), "it fails");
  renderer.render();
  EXPECT_LT(rmse(renderer.read(), best), 1e-6);
}

/// On the way from one level to the next, lights or blocks, each of eight frames changes the picture by an
/// eighth of what the level changes, whichever pixels tell the lights apart, and whichever batch they are in.
/// Light that is subtracted changes by an eighth before negative light is cut off, and what coats see changes
/// with the width of their mirrors besides.
TEST_F(SubtractiveLevelsTest, NoFrameChangesMoreThanItsShareOfALevel) {
  constexpr int kFramesOfLevel = 8;
  constexpr std::pair<const char*, const char*> kLevels[] = {
      {"14", "2"}, {"9", "2"}, {"8", "2"}, {"8", "4"}, {"8", "8"}};
  const auto fading = [&](const std::string& name, const Values& common, double clamped = 1) {
    const scene::Scene scene = lit(asset(name), sky(), 0);
    render::Renderer renderer(device(), scene);
    const auto with = [&](const std::pair<const char*, const char*>& level, const char* time) {
      Values values{
          {"shadow_map_size", "128"}, {"lights", level.first}, {"block", level.second}, {"frame_time", time}};
      values.insert(values.end(), common.begin(), common.end());
      return settings(48, 36, Term::direct, {shadows(values)});
    };
    std::vector<Image> levels;
    for (const auto& level : kLevels) levels.push_back(picture(renderer, with(level, "0")));
    const double rounding = 5e-5 * largest(levels.front());
    size_t level = 0;
    double most = 0;
    renderer.configure(with(kLevels[0], "0.001"));
    Image before = levels.front();
    for (int frame = 0; frame < 100 && level + 1 < levels.size(); ++frame) {
      renderer.render();
      Image now = renderer.read();
      const double whole = largestDifference(levels[level], levels[level + 1]);
      EXPECT_LT(largestDifference(now, before), clamped * whole / kFramesOfLevel + rounding)
          << name << " from level " << level << " at frame " << frame;
      most = std::max(most, largestDifference(now, before) / whole);
      if (largestDifference(now, levels[level + 1]) < rounding) ++level;
      before = std::move(now);
    }
    EXPECT_EQ(level + 1, levels.size()) << name;
    return std::to_string(most);
  };
  RecordProperty("subtract", fading("balls", {{"combine", "subtract"}}, 2));
  RecordProperty("ratios, in batches", fading("balls", {{"combine", "ratio_split"}, {"memory", "1"}}));
  RecordProperty("coats", fading("fresnel_spheres", {{"combine", "ratio_split"}}, 1.2));
}

/// Light comes from the same directions wherever the camera is: as it moves by a pixel a frame, the shadows
/// of 8 lights lie where they were, and those of blocks nearly so.
TEST_F(SubtractiveLevelsTest, ShadowsStandStillWhereTheCameraMoves) {
  constexpr int kWidth = 64, kHeight = 48;
  scene::Scene scene = lit(floor(), sky(), 0);
  scene::Node slab;  // above the camera
  slab.mesh = 0;
  slab.transform.translation = {0.5f, 5, 0.5f};
  slab.transform.scale = vec3(0.02f);
  scene.nodes.push_back(slab);
  render::Renderer renderer(device(), scene);
  const auto change = [&](const char* block) {
    renderer.configure(
        settings(kWidth, kHeight, Term::direct, {shadows({{"lights", "8"}, {"block", block}})}));
    scene::CameraPose camera = scene::evaluate(scene, 0).cameras.at(0);
    const float pixel = 2 * 4 * std::tan(0.5f * camera.yfov) / static_cast<float>(kHeight);
    Image before;
    double squares = 0, light = 0;
    for (int frame = 0; frame <= 4; ++frame) {
      renderer.setCamera(camera);
      renderer.render();
      const Image now = renderer.read();
      for (int y = 0; frame > 0 && y < kHeight; ++y)
        for (int x = 0; x + 1 < kWidth; ++x) {
          const double difference = static_cast<double>(now.at(x, y, 1) - before.at(x + 1, y, 1));
          squares += difference * difference;
          light += static_cast<double>(now.at(x, y, 1) * now.at(x, y, 1));
        }
      before = now;
      camera.worldToView[3].x -= pixel;
    }
    RecordProperty(block, std::to_string(std::sqrt(squares / light)));
    return std::sqrt(squares / light);
  };
  EXPECT_LT(change("1"), 0.005);
  EXPECT_LT(change("4"), 0.05);
}

/// The same as the camera rolls by quarters of a turn, which leave every pixel what it sees: a satin ball on
/// the floor, with highlights and a shadow.
TEST_F(SubtractiveLevelsTest, ShadowsStandStillWhereTheCameraTurns) {
  constexpr int kSide = 64;
  scene::Scene scene = lit(floor(), sky(), 0);
  scene.materials.push_back(metal(glm::vec4(1, 0.8f, 0.5f, 1), 0.3f));
  scene.meshes.push_back({"ball", {test::spherePrimitive(0.6f, 1)}, {}});
  scene::Node ball;
  ball.mesh = 1;
  ball.transform.translation = {0.2f, 0.6f, -0.1f};
  scene.nodes.push_back(ball);
  render::Renderer renderer(device(), scene);
  const auto change = [&](const char* block) {
    renderer.configure(settings(kSide, kSide, Term::direct, {shadows({{"lights", "8"}, {"block", block}})}));
    scene::CameraPose camera = scene::evaluate(scene, 0).cameras.at(0);
    glm::mat4 quarter(1);
    quarter[0] = {0, 1, 0, 0};
    quarter[1] = {-1, 0, 0, 0};
    Image before;
    double squares = 0, light = 0, unturned = 0;
    for (int frame = 0; frame <= 4; ++frame) {
      renderer.setCamera(camera);
      renderer.render();
      const Image now = renderer.read();
      for (int y = 0; frame > 0 && y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          const float turned = now.at(y, kSide - 1 - x, 1), own = before.at(x, y, 1);
          squares += std::pow(double(turned) - own, 2);
          unturned += std::pow(double(now.at(x, y, 1)) - own, 2);
          light += double(own) * own;
        }
      before = now;
      camera.worldToView = quarter * camera.worldToView;
    }
    RecordProperty(block, std::to_string(std::sqrt(squares / light)));
    EXPECT_GT(std::sqrt(unturned / light), 0.1) << "the picture turns";
    return std::sqrt(squares / light);
  };
  EXPECT_LT(change("1"), 0.005);
  EXPECT_LT(change("4"), 0.05);
}

}  // namespace
}  // namespace limn
