// A scene far from the origin is the same scene: picture and reference are those of the scene that lies near
// it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "core/reference/reference.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

using json = nlohmann::json;
using namespace nlohmann::literals;

constexpr const char* kWhiteTexel =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5E"
    "rkJggg==";

enum class By { translation, matrix, chain };

/// Puts the document's roots below a new node at (x, 2 x, -x), which a matrix or several nodes may stand for.
void shift(json& document, double x, By by) {
  json& roots = document["scenes"][0]["nodes"];
  json& nodes = document["nodes"];
  const json translation = {x, 2 * x, -x};
  json node = {{"children", roots}};
  if (by == By::matrix)
    node["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 2 * x, -x, 1};
  else
    node["translation"] = translation;
  if (document["scenes"][0].contains("/extras/limn_medium/smoke"_json_pointer))
    for (const char* corner : {"low", "high"})
      for (size_t axis = 0; axis < 3; ++axis) {
        json& value = document["scenes"][0]["extras"]["limn_medium"]["smoke"][corner][axis];
        value = value.get<double>() + translation[axis].get<double>();
      }
  nodes.push_back(node);
  if (by == By::chain) {  // two nodes that almost cancel
    nodes.back()["translation"] = {x + 0.375, 2 * x, -x};
    nodes.push_back({{"children", {nodes.size() - 1}}, {"translation", {-0.375, 0, 0}}});
  }
  roots = {nodes.size() - 1};
}

/// An asset, moved.
scene::Scene moved(const std::string& name, double x, By by) {
  const auto file = std::filesystem::path(test::kBinaryDir) / "assets" / name / (name + ".glb");
  std::vector<std::byte> glb = readFile(file);
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    std::memcpy(&value, &glb[at], 4);
    return value;
  };
  const size_t length = word(12);
  json document =
      json::parse(reinterpret_cast<const char*>(&glb[20]), reinterpret_cast<const char*>(&glb[20]) + length);
  shift(document, x, by);
  if (document.contains("images"))
    for (json& image : document["images"])  // what is not in the file: one white texel
      if (image.contains("uri")) image["uri"] = kWhiteTexel;
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  std::vector<std::byte> out(glb.begin(), glb.begin() + 20);
  out.insert(out.end(), bytes, bytes + text.size());
  out.insert(out.end(), glb.begin() + 20 + static_cast<std::ptrdiff_t>(length), glb.end());
  const auto put = [&](size_t at, size_t value) {
    const auto v = static_cast<uint32_t>(value);
    std::memcpy(&out[at], &v, 4);
  };
  put(8, out.size());
  put(12, text.size());
  return scene::loadMemory(out);
}

/// Mean absolute difference over the mean of `a`; NaN where a value is none.
double difference(const Image& a, const Image& b) {
  double error = 0, sum = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        error += std::abs(double(a.at(x, y, c)) - b.at(x, y, c));
        sum += a.at(x, y, c);
      }
  return sum > 0 ? error / sum : error;
}

class FarTest : public RenderTest {
 protected:
  static Image picture(const scene::Scene& scene, std::vector<render::TechniqueUse> techniques) {
    render::Renderer renderer(device(), scene);
    return PictureTest::picture(renderer, settings(48, 48, Term::final, std::move(techniques)),
                                scene::evaluate(scene, 0).cameras.front());
  }
  static Image truth(const scene::Scene& scene) {
    const scene::Pose pose = scene::evaluate(scene, 0);
    reference::Request asked =
        test::request(scene, pose, pose.cameras.front(), glm::ivec2(48), Term::final, 16);
    asked.bounces = 1;
    return reference::render(asked).image;
  }
};

TEST_F(FarTest, TheReferenceIsTheSameAnywhere) {
  const Image near = truth(moved("cornell_box", 0, By::translation));
  for (const double x : {1e5, 1e7})
    for (const By by : {By::translation, By::matrix, By::chain})
      EXPECT_LT(difference(near, truth(moved("cornell_box", x, by))), 1e-4) << x << " " << int(by);
}

TEST_F(FarTest, EveryTechniqueIsTheSameAnywhere) {
  const scene::Scene near = moved("cornell_box", 0, By::translation);
  const scene::Scene far = moved("cornell_box", 1e5, By::matrix),
                     farther = moved("cornell_box", 1e7, By::chain);
  for (const TechniquePlugin* plugin : testedTechniques()) {
    SCOPED_TRACE(plugin->info->name);
    const Image expected = picture(near, {quick(plugin->info->name)});
    EXPECT_LT(difference(expected, picture(far, {quick(plugin->info->name)})), 5e-3);
    EXPECT_LT(difference(expected, picture(farther, {quick(plugin->info->name)})), 5e-3);
  }
}

/// Fog in a room, smoke that the scene's file places, and surfaces that are made for every time.
TEST_F(FarTest, MediaAndMetaballsAreTheSameAnywhere) {
  const std::vector<render::TechniqueUse> techniques = {quick("hard_shadow_map"), quick("airlight")};
  for (const char* name : {"cornell_box", "smoke", "metaballs"}) {
    SCOPED_TRACE(name);
    const auto at = [&](double x, By by) {
      scene::Scene scene = moved(name, x, by);
      if (!scene.medium.present()) {
        scene.medium.sigmaA = glm::vec3(0.1f);
        scene.medium.sigmaS = glm::vec3(0.2f, 0.3f, 0.4f);
      }
      return scene;
    };
    const scene::Scene near = at(0, By::translation);
    const Image seen = picture(near, techniques), exact = truth(near);
    for (const auto& [x, by] : {std::pair(1e5, By::matrix), std::pair(1e7, By::chain)}) {
      SCOPED_TRACE(x);
      const scene::Scene far = at(x, by);
      ASSERT_NE(far.origin, glm::dvec3(0));
      EXPECT_LT(difference(seen, picture(far, techniques)), 5e-3);
      EXPECT_LT(difference(exact, truth(far)), 1e-3);
    }
  }
}

TEST_F(FarTest, NearbyScenesKeepTheirOrigin) {
  for (const char* name : {"atrium", "balls", "cornell_box", "robot"}) {
    const scene::Scene scene = asset(name);
    EXPECT_EQ(scene.origin, glm::dvec3(0)) << name;
    EXPECT_TRUE(scene::evaluate(scene, 0).nodeToWorldExact.empty()) << name;
  }
}

TEST_F(FarTest, AnimatedAndSkinnedNodesComeAlong) {
  const scene::Scene near = moved("robot", 0, By::translation), far = moved("robot", 1e7, By::chain);
  ASSERT_NE(far.origin, glm::dvec3(0));
  for (const double time : {0.0, 0.37}) {
    const scene::Pose a = scene::evaluate(near, time), b = scene::evaluate(far, time);
    const glm::vec3 shift(glm::dvec3(1e7, 2e7, -1e7) - far.origin);
    ASSERT_EQ(a.instances.size(), b.instances.size());
    for (size_t i = 0; i < a.instances.size(); ++i) {
      const scene::Bounds x = scene::instanceBounds(near, a, a.instances[i]),
                          y = scene::instanceBounds(far, b, b.instances[i]);
      EXPECT_LT(glm::length(x.low + shift - y.low), 1e-4f * a.bounds.radius());
      EXPECT_LT(glm::length(x.high + shift - y.high), 1e-4f * a.bounds.radius());
    }
  }
}

}  // namespace
}  // namespace limn
