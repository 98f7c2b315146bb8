// prefiltered_environment on materials with a model: against the reference without shadows, and under light
// that is brighter than half floats hold.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/reference/reference.h"
#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "glsl/light/prefiltered_models.glsl"
#include "glsl/numeric/equirectangular.glsl"
#include "tests/gpu/render_test.h"
#include "tests/support/environment_maps.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using glm::vec2;
using glm::vec3;

class PrefilteredEnvironmentTest : public RenderTest {
 protected:
  static constexpr int kBallSide = 40;  ///< pixels of a square around each ball
  using Models = std::vector<glsl::MaterialModel>;

  static glsl::MaterialModel model(uint32_t kind, float roughness = 0.3f) {
    glsl::MaterialModel m{};
    m.kind = kind;
    m.eta = vec3(0.22f, 0.94f, 1.17f);
    m.k = vec3(3.64f, 2.59f, 2.39f);
    m.ks = vec3(1);
    m.roughness = vec2(roughness);
    return m;
  }
  static glsl::MaterialModel mirrorOf(glsl::MaterialModel m) {
    m.eta = vec3(1e-3f);
    m.k = vec3(1000);
    return m;
  }
  static glsl::MaterialModel lambert() {
    glsl::MaterialModel m = model(glsl::model_phong);
    m.ks = vec3(0);
    m.kd = vec3(1);
    return m;
  }

  /// Balls in a row, to be seen from afar.
  static scene::Scene row(const Models& models, scene::Environment environment) {
    scene::Scene scene;
    for (size_t i = 0; i < models.size(); ++i) {
      scene::Material material;
      scene::setModel(material, models[i]);
      scene::Node node;
      node.mesh = test::addMesh(scene, test::spherePrimitive(0.95f, test::addMaterial(scene, material)));
      node.transform.translation.x = 2 * static_cast<float>(i) + 1 - static_cast<float>(models.size());
      scene.nodes.push_back(node);
    }
    scene.environment = std::move(environment);
    return scene;
  }
  static scene::CameraPose camera(const vec3& towards = {0, 0, 1}) {
    return scene::lookAt(50.f * towards, {0, 0, 0}, 2 * std::atan(0.02f));
  }

  using Values = std::vector<std::pair<std::string, std::string>>;

  /// Pictures of a row, which must outlive it, by one renderer: its programs are compiled once.
  class Drawing {
   public:
    explicit Drawing(const scene::Scene& scene)
        : width_(kBallSide * static_cast<int>(scene.nodes.size())), renderer_(device(), scene) {}
    Image with(Values values, const scene::CameraPose& view = camera()) {
      values.emplace(values.begin(), "size", "128");  // another size stands behind it
      return picture(
          renderer_,
          settings(width_, kBallSide, Term::direct, {technique("prefiltered_environment", values)}), view);
    }

   private:
    const int width_;
    render::Renderer renderer_;
  };
  static Image drawn(const scene::Scene& scene, Values values = {}) {
    return Drawing(scene).with(std::move(values));
  }

  /// Counts the technique's passes by name.
  std::map<std::string, int> passesOf(const scene::Scene& scene, Term term = Term::direct) {
    render::Renderer renderer(device(), scene);
    picture(renderer, settings(8, 8, term, {technique("prefiltered_environment", {{"size", "128"}})}),
            camera());
    std::map<std::string, int> passes;
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.technique == "prefiltered_environment") ++passes[pass.name];
    return passes;
  }

  static Image traced(const scene::Scene& scene) {
    const scene::Pose pose = scene::evaluate(scene, 0);
    const int width = kBallSide * static_cast<int>(scene.nodes.size());
    reference::Request asked = test::request(scene, pose, camera(), {width, kBallSide}, Term::direct, 128);
    asked.unshadowed = true;
    return reference::render(asked).image.select({"R", "G", "B"});
  }

  /// Returns how much more light each quarter of a ball has than in `exact`, over what it has there; the
  /// first channel.
  static std::array<double, 4> excess(const Image& image, const Image& exact, int ball) {
    std::array<double, 4> light{}, expected{};
    for (int y = 0; y < kBallSide; ++y)
      for (int x = 0; x < kBallSide; ++x) {
        const auto quarter = static_cast<size_t>(2 * x / kBallSide + 2 * (2 * y / kBallSide));
        light[quarter] += static_cast<double>(image.at(ball * kBallSide + x, y, 0));
        expected[quarter] += static_cast<double>(exact.at(ball * kBallSide + x, y, 0));
      }
    for (size_t i = 0; i < 4; ++i) light[i] = light[i] / expected[i] - 1;
    return light;
  }
};

/// Under light that is linear in the direction, quarters of a ball differ by half and more. On the processor,
/// with lobes' means in closed form, lookups at the middle of lobes are off the reference by 0.001 of the
/// light of a quarter for microfacets, 0.003 for Phong's lobe, 0.0015 for a coat, and 0.013 for fibres, which
/// are taken for Lambertian; lookups along the mirror direction leave microfacets up to 0.046 short. Of that
/// the reference's noise is 0.0007. The bounds leave 0.006 to maps and tables.
TEST_F(PrefilteredEnvironmentTest, EveryModelHasItsLightOfASmoothEnvironment) {
  glsl::MaterialModel fibres = model(glsl::model_banks), phong = model(glsl::model_phong),
                      coat = model(glsl::model_coated);
  fibres.ks = vec3(0);
  fibres.kd = vec3(0.3f);
  fibres.exponent = 8;
  phong.kd = vec3(0.3f);
  phong.ks = vec3(0.6f);
  phong.exponent = 20;
  coat.eta = vec3(1.5f);
  coat.k = vec3(0);
  coat.kd = vec3(0.7f);
  coat.options = glsl::model_option_physical;
  const struct {
    const char* name;
    glsl::MaterialModel model;
    double bound;
  } balls[] = {{"torrance_sparrow", model(glsl::model_torrance_sparrow), 0.007},
               {"ward", model(glsl::model_ward), 0.007},
               {"banks", fibres, 0.019},
               {"phong", phong, 0.009},
               {"coated", coat, 0.0075}};
  Models models;
  for (const auto& ball : balls) models.push_back(ball.model);
  const vec3 bright = glm::normalize(vec3(1));
  const scene::Scene scene =
      row(models, test::environmentOf(256, [&](vec3 d) { return vec3(1 + 0.8f * glm::dot(d, bright)); }));
  const Image exact = traced(scene);
  Drawing drawing(scene);
  for (const char* map : {"paraboloid", "equirectangular"}) {
    const Image image = drawing.with({{"map", map}});
    for (size_t i = 0; i < models.size(); ++i) {
      double worst = 0;
      for (const double more : excess(image, exact, static_cast<int>(i)))
        worst = std::max(worst, std::abs(more));
      RecordProperty(std::string(map) + " " + balls[i].name, std::to_string(worst));
      EXPECT_LT(worst, balls[i].bound) << map << ' ' << balls[i].name;
    }
  }
  const Image mirror = drawing.with({{"lookup", "mirror"}});
  const std::array<double, 4> along = excess(mirror, exact, 0);
  EXPECT_LT(*std::ranges::min_element(along), -0.02);
}

/// Schlick's approximation is linear in the reflectance head-on, and so are pictures by it: each lies between
/// those of a mirror and of an index of 1. Fresnel's equations are not.
TEST_F(PrefilteredEnvironmentTest, SchlicksReflectanceIsLinearInThatHeadOn) {
  const vec3 bright = glm::normalize(vec3(1));
  const scene::Environment sky =
      test::environmentOf(64, [&](vec3 d) { return vec3(1 + 0.8f * glm::dot(d, bright)); });
  for (const uint32_t kind : {glsl::model_coated, glsl::model_torrance_sparrow, glsl::model_ward}) {
    const auto with = [&](float eta, float k, const char* fresnel) {
      glsl::MaterialModel m = model(kind);
      m.eta = vec3(eta);
      m.k = vec3(k);
      return drawn(row({m}, sky), {{"fresnel", fresnel}});
    };
    const Image none = with(1, 0, "schlick"), all = with(1e-3f, 1000, "schlick");
    for (const auto& [eta, k] : {std::pair(1.5f, 0.f), std::pair(5.f, 0.f), std::pair(1.37f, 7.62f)}) {
      const float headOn = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
      Image expected = all;
      for (size_t i = 0; i < expected.data().size(); ++i)
        expected.data()[i] = headOn * all.data()[i] + (1 - headOn) * none.data()[i];
      const double schlick = rmse(with(eta, k, "schlick"), expected);
      const double exact = rmse(with(eta, k, "exact"), expected);
      RecordProperty(std::to_string(kind) + " of " + std::to_string(eta),
                     std::to_string(schlick) + " " + std::to_string(exact));
      EXPECT_LT(schlick, 1e-5) << kind << ' ' << eta;
      EXPECT_GT(exact, 3e-3) << kind << ' ' << eta;
    }
  }
}

/// A coat on a white base reflects all of uniform light: by either reflectance, what it mirrors is what the
/// base lacks.
TEST_F(PrefilteredEnvironmentTest, PhysicalCoatsKeepTheirEnergyByEitherReflectance) {
  glsl::MaterialModel coat = model(glsl::model_coated);
  coat.eta = vec3(1.5f);
  coat.k = vec3(0);
  coat.kd = vec3(1);
  coat.options = glsl::model_option_physical;
  const auto uniform = [](const glsl::MaterialModel& m) {
    return row({m}, test::environmentOf(64, [](vec3) { return vec3(1); }));
  };
  const Image white = drawn(uniform(lambert()));
  for (const char* fresnel : {"exact", "schlick"})
    EXPECT_LT(rmse(drawn(uniform(coat), {{"fresnel", fresnel}}), white), 2e-3) << fresnel;
}

/// A GGX lobe of a material that nothing is drawn with has no map, either.
TEST_F(PrefilteredEnvironmentTest, MapsThatNoSurfaceLooksUpAreLeftOut) {
  glsl::MaterialModel phong = model(glsl::model_phong), coat = model(glsl::model_coated);
  phong.exponent = 20;
  coat.options = glsl::model_option_physical;
  scene::Material matte, glossy, glass;
  matte.metallic = matte.specularFactor = 0;
  glossy.metallic = 0;
  glass.transmission = 1;
  const auto withModel = [](const glsl::MaterialModel& m) {
    scene::Material material;
    scene::setModel(material, m);
    return material;
  };
  const struct {
    const char* name;
    scene::Material material;
    int sharp, ggx, power, grazing;  ///< passes of each kind of map
  } cases[] = {{"matte", matte, 0, 0, 0, 0},
               {"glass", glass, 0, 0, 0, 0},
               {"glossy", glossy, 1, 1, 0, 0},
               {"phong", withModel(phong), 1, 0, 1, 0},
               {"banks", withModel(model(glsl::model_banks)), 0, 0, 0, 0},
               {"coated", withModel(coat), 1, 0, 0, 1}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    scene::Scene scene = row({lambert()}, test::environmentOf(64, [](vec3 d) { return vec3(1) + d; }));
    scene.materials[0] = c.material;
    std::map<std::string, int> passes = passesOf(scene);
    EXPECT_EQ(passes["irradiance of the environment"], 1);
    EXPECT_EQ(passes["resample environment level 0"], c.sharp);
    EXPECT_EQ(passes["filter environment level 1"], c.ggx);
    EXPECT_EQ(passes["filter environment with power lobes, level 1"], c.power);
    EXPECT_EQ(passes["grazing irradiance of the environment"], c.grazing);
    const Image alone = drawn(scene);
    test::addMaterial(scene, glossy);
    EXPECT_EQ(passesOf(scene)["filter environment level 1"], c.ggx);
    EXPECT_EQ(rmse(drawn(scene), alone), 0);
  }
}

/// What the boundary of a body reflects and what enters it are asked for apart, and look into the same maps.
TEST_F(PrefilteredEnvironmentTest, BodiesHaveTheirMapsFilteredOnce) {
  scene::Scene scene = row({lambert()}, test::environmentOf(64, [](vec3 d) { return vec3(1) + d; }));
  scene::Material body;
  body.metallic = 0;
  body.subsurface = scene::Subsurface{.extinction = vec3(1e6f), .absorption = vec3(0.1f)};
  scene.materials[0] = body;
  std::map<std::string, int> passes = passesOf(scene, Term::final);
  EXPECT_EQ(passes["environment light"], 1);
  EXPECT_EQ(passes["environment light 2"], 1);  // the second of a name has its number
  for (const std::string map : {"irradiance of the environment", "grazing irradiance of the environment",
                                "resample environment level 0", "filter environment level 1"}) {
    EXPECT_EQ(passes[map], 1) << map;
    EXPECT_EQ(passes[map + " 2"], 0) << map;
  }
}

/// Under a sky of the radiance 1 + 0.8 d.y a white ball has 1 + 0.8 (2/3) n.y, from whichever side it is
/// seen: also where the picture is a single column, whose texels reach all around, and where it is so wide
/// that a thread of a software renderer does not come to the end of its pixels. Of that one 8 rows are summed
/// over, which takes 0.006 of the light at n.y = 0.5; the rest of the bound is that of the other tests' maps.
TEST_F(PrefilteredEnvironmentTest, PicturesOfAnyShapeHaveTheirIrradiance) {
  for (const glm::ivec2& size : {glm::ivec2(1, 512), glm::ivec2(3, 64), glm::ivec2(4096, 32)}) {
    scene::Environment sky;
    sky.width = size.x;
    sky.height = size.y;
    for (int y = 0; y < size.y; ++y) {
      const vec2 middle(0.5f, (static_cast<float>(y) + 0.5f) / static_cast<float>(size.y));
      sky.texels.insert(sky.texels.end(), static_cast<size_t>(size.x),
                        vec3(1 + 0.8f * glsl::equirectangular_direction(middle).y));
    }
    const scene::Scene scene = row({lambert()}, sky);
    Drawing drawing(scene);
    for (const char* map : {"paraboloid", "equirectangular"})
      for (const vec3& side : {vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 0, -1)}) {
        SCOPED_TRACE(std::to_string(size.x) + " x " + std::to_string(size.y) + ' ' + map);
        const Image image = drawing.with({{"map", map}}, camera(side));
        // Where n.y is 0.5 and -0.5: half of the ball's radius, 0.95 of half the picture.
        EXPECT_NEAR(image.at(kBallSide / 2, 10, 0), 1 + 0.8f / 3, 0.02f);
        EXPECT_NEAR(image.at(kBallSide / 2, kBallSide - 11, 0), 1 - 0.8f / 3, 0.02f);
      }
  }
}

/// Coarser levels of an equirectangular map whose size is no power of two may have an odd number of columns:
/// 25 for 200, of which the last one makes no whole group, and 31 for 250. The widest lobe makes 1 + 0.4 d.b
/// of the sky, of which linear lookups between texels of 1/11 of a half turn miss 0.4 (pi / 11)^2 / 4 =
/// 0.008, and the levels that its samples look into 0.002. The ball is seen from where columns begin, where
/// one that is too many turns the map by 0.4 (2 pi / 31) / sqrt(3) = 0.05, and from across it.
TEST_F(PrefilteredEnvironmentTest, MapsOfAnySizeAreRound) {
  glsl::MaterialModel wide = model(glsl::model_phong);
  wide.exponent = 0;
  const vec3 bright = glm::normalize(vec3(1));
  const scene::Scene scene =
      row({wide}, test::environmentOf(128, [&](vec3 d) { return vec3(1 + 0.8f * glm::dot(d, bright)); }));
  Drawing drawing(scene);
  for (const vec3& side : {vec3(0, 0, 1), vec3(-1, 0, 0)}) {
    const auto with = [&](const char* size) {
      return drawing.with({{"map", "equirectangular"}, {"size", size}, {"samples", "32"}}, camera(side));
    };
    const Image expected = with("256");
    for (const char* size : {"200", "250"}) {
      const Image image = with(size);
      float worst = 0;
      for (int y = 0; y < kBallSide; ++y)
        for (int x = 0; x < kBallSide; ++x)
          worst = std::max(worst, std::abs(image.at(x, y, 0) - expected.at(x, y, 0)));
      RecordProperty(std::string(size) + " from " + std::to_string(side.z), std::to_string(worst));
      EXPECT_LT(worst, 0.02f) << size << ' ' << side.z;
    }
  }
}

/// A small sun on the side of the camera: what faces it has its irradiance, and nothing is brighter than it.
TEST_F(PrefilteredEnvironmentTest, ABrightSunKeepsItsIrradiance) {
  constexpr float kSun = 1e5f;
  const scene::Environment sun =
      test::environmentOf(256, [](vec3 d) { return vec3(d.z > std::cos(0.1f) ? kSun : 0.f); });
  double irradiance = 0;
  for (int y = 0; y < sun.height; ++y)
    for (int x = 0; x < sun.width; ++x) {
      const double polar = M_PI * (y + 0.5) / sun.height;
      const vec3 d = glsl::equirectangular_direction((vec2(x, y) + 0.5f) / vec2(sun.width, sun.height));
      irradiance += static_cast<double>(sun.texels[static_cast<size_t>(y * sun.width + x)].x * d.z) * 2 *
                    M_PI * M_PI / (sun.width * sun.height) * std::sin(polar);
    }
  glsl::MaterialModel narrow = model(glsl::model_phong), coat = model(glsl::model_coated);
  narrow.exponent = 1000;
  coat.options = glsl::model_option_physical;
  const scene::Scene scene = row({lambert(), model(glsl::model_torrance_sparrow, 0.05f), narrow, coat}, sun);
  Drawing drawing(scene);
  for (const char* map : {"paraboloid", "equirectangular"}) {
    const Image image = drawing.with({{"map", map}});
    expectWithin(image, 0, 1.01f * kSun);
    const double facing = static_cast<double>(image.at(kBallSide / 2, kBallSide / 2, 0));
    EXPECT_NEAR(facing / (irradiance / M_PI), 1, 0.03) << map;
  }
}

/// A sun of one pixel where maps have their rims and poles: a ball is seen from its side.
TEST_F(PrefilteredEnvironmentTest, ASunOfOnePixelKeepsItsIrradianceEverywhere) {
  constexpr int kWidth = 512, kHeight = 256;
  constexpr glm::ivec2 kSuns[] = {{383, 101}, {383, 100}, {383, 96}, {383, 116}, {128, 128},
                                  {447, 64},  {10, 1},    {10, 3},   {10, 5},    {300, 254}};
  for (const glm::ivec2& at : kSuns) {
    scene::Environment sun = test::environmentOf(kWidth, [](vec3) { return vec3(0); });
    sun.texels[static_cast<size_t>(at.y * kWidth + at.x)] = vec3(1e5f);
    const scene::Scene scene = row({lambert()}, sun);
    const vec3 towards = glsl::equirectangular_direction((vec2(at) + 0.5f) / vec2(kWidth, kHeight));
    const float facing = 1e5f * glsl::equirectangular_pixel_solid_angle(at.y, kWidth, kHeight) / glsl::pi;
    Drawing drawing(scene);
    for (const char* map : {"paraboloid", "equirectangular"}) {
      const Image image = drawing.with({{"map", map}}, camera(towards));
      EXPECT_NEAR(static_cast<double>(image.at(kBallSide / 2, kBallSide / 2, 0) / facing), 1, 0.02)
          << map << " (" << at.x << ", " << at.y << ')';
    }
  }
}

/// All directions have more than a half float holds.
TEST_F(PrefilteredEnvironmentTest, BrightLightComesOffEverySurface) {
  constexpr float kBright = 1e6f;
  glsl::MaterialModel phong = model(glsl::model_phong), coat = mirrorOf(model(glsl::model_coated));
  phong.exponent = 20;
  scene::Scene scene = row({lambert(), mirrorOf(model(glsl::model_torrance_sparrow)), phong, coat, lambert()},
                           test::environmentOf(256, [](vec3) { return vec3(kBright); }));
  scene::Material metal;  // of a GGX lobe, which loses less than 1 % of the light at this width
  metal.metallic = 1;
  metal.roughness = 0.3f;
  scene.materials.back() = metal;
  const Image image = drawn(scene);
  const auto middle = [&](int ball) { return image.at(ball * kBallSide + kBallSide / 2, kBallSide / 2, 0); };
  const float reflected = glsl::microfacet_lobe(1, 0.3f, 1024).reflectance;
  EXPECT_NEAR(middle(0), kBright, 5e-3f * kBright);
  EXPECT_NEAR(middle(1), reflected * kBright, 0.01f * kBright);
  EXPECT_NEAR(middle(2), kBright, 0.01f * kBright);
  EXPECT_NEAR(middle(3), kBright, 1e-3f * kBright);
  EXPECT_NEAR(middle(4), kBright, 0.02f * kBright);
  expectWithin(image, 0, 1.01f * kBright);
}

}  // namespace
}  // namespace limn
