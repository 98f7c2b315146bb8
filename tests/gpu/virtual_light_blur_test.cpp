// What the blur of interleaved pixels makes of surfaces of several materials that lie in one plane.
#include <gmock/gmock.h>

#include <utility>

#include "core/scene/material_model.h"
#include "glsl/materials/model.glsl"
#include "tests/gpu/corner_scene.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

using VirtualLightBlurTest = CornerTest;

/// A matte black plate on a wall of metal, with interleaved pixels: it reflects nothing of what the blur
/// averages around it, and the metal beside it keeps its light, to what the highlight changes across the
/// blur's reach.
TEST_F(VirtualLightBlurTest, TheBlurKeepsHighlightsToTheirMaterials) {
  scene::Material metal = test::lambert(Corner::albedo);
  metal.metallic = 1;
  metal.roughness = 0.5f;
  Corner bare, plated;
  for (Corner* s : {&bare, &plated}) s->paintWall(metal);
  const int plate = addMesh(plated.scene, floorPrimitive(0.15f, addMaterial(plated.scene, test::lambert(0))));
  addInstance(plated.scene, plated.pose, plate,
              glm::translate(glm::mat4(1), {0.999f, 0.4f, 0}) *
                  glm::rotate(glm::mat4(1), 0.5f * glsl::pi, vec3(0, 0, 1)));
  for (const auto& [parameter, value] :
       {std::pair("history", "1"), std::pair("history", "4"), std::pair("edges", "0.1")}) {
    const Settings interleaved{{"vpls", "64"}, {"block", "8"}, {parameter, value}};
    const Answer without = answer("reflective_shadow_map", bare, interleaved);
    const Answer with = answer("reflective_shadow_map", plated, interleaved);
    const auto shows = [&](int x, int y, uint32_t instance) {
      return x >= 0 && y >= 0 && x < side && y < side &&
             with.instance[static_cast<size_t>(y * side + x)] == instance;
    };
    int black = 0;
    double before = 0, after = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (shows(x, y, 2)) {
          EXPECT_EQ(with.at(0, x, y), 0) << parameter << value << ": " << x << "," << y;
          ++black;
        }
        constexpr int beside = 3;  // pixels
        const bool near = shows(x - beside, y, 2) || shows(x + beside, y, 2) || shows(x, y - beside, 2) ||
                          shows(x, y + beside, 2);
        if (!shows(x, y, 1) || !near) continue;
        before += double(without.at(0, x, y));
        after += double(with.at(0, x, y));
      }
    }
    EXPECT_GT(black, 30);
    EXPECT_NEAR(after / before, 1, 0.05) << parameter << value;
  }
}

/// A matte plate before a wall that a model reflects for, which has no diffuse part: interleaved pixels of
/// the plate have the light that they would have alone, to what it changes across the blur's reach.
TEST_F(VirtualLightBlurTest, TheBlurTakesNothingFromWhatLiesBesideAModel) {
  glsl::MaterialModel phong{};
  phong.kind = glsl::model_phong;
  phong.exponent = 20;
  phong.kd = vec3(0.3f);
  phong.ks = vec3(0.5f);
  scene::Material painted = test::lambert(Corner::albedo);
  scene::setModel(painted, phong);
  Corner s;
  s.paintWall(painted);
  s.addPlate(0.999f);
  const auto ofPlate = [&](const char* block) {
    const Answer v = answer("reflective_shadow_map", s, {{"vpls", "64"}, {"block", block}});
    double sum = 0;
    for (size_t i = 0; i < v.instance.size(); ++i)
      if (v.instance[i] == 2) sum += double(v.lights[0][i]);
    return sum;
  };
  const double alone = ofPlate("1");
  ASSERT_GT(alone, 0);
  EXPECT_NEAR(ofPlate("8") / alone, 1, 0.08);
}

}  // namespace
}  // namespace limn
