// The light without shadows that subtractive_shadows starts from, by samples of lobes and by its cache, where
// nothing hides the environment: against closed forms, against sums of the same lobes, and at extremes.
#include <cmath>

#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "glsl/light/ltc.glsl"
#include "glsl/surface/lobe_samples.glsl"
#include "glsl/surface/nearest_brdf.glsl"
#include "tests/gpu/environment_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kOddWidth = 33, kOddHeight = 25;  // odd: the pixel in the middle looks along the normal
constexpr float kSmooth = 13 / 255.f;           // the smoothest metal that takes light
const std::vector<float> kRoughnesses{kSmooth, 153 / 255.f, 1};  // exact in the G-buffer

class UnshadowedEnvironmentTest : public EnvironmentTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  static scene::Material metal(float roughness, vec3 colour = {1, 0.5f, 0.2f}) {
    scene::Material material;
    material.baseColour = glm::vec4(colour, 1);
    material.roughness = roughness;
    return material;
  }

  /// A floor that nothing hides the sky from.
  static scene::Scene floorOf(const scene::Material& material, scene::Environment environment) {
    scene::Scene scene = lit(floor(), std::move(environment), 0);
    scene.materials[0] = material;
    return scene;
  }

  /// Draws the floor once more with that material, below itself.
  static void addBelow(scene::Scene& scene, int material) {
    scene::Primitive hidden = scene.meshes[0].primitives[0];
    hidden.material = material;
    scene::Node node;
    node.mesh = static_cast<int>(scene.meshes.size());
    node.transform.translation = {0, -1, 0};
    scene.meshes.push_back({"below the floor", {std::move(hidden)}, {}});
    scene.nodes.push_back(node);
  }

  static vec3 linear(vec3 d) { return 1.f + 0.8f * d; }

  static Image light(render::Renderer& renderer, const std::string& unshadowed, Values values = {}) {
    values.emplace_back("unshadowed", unshadowed);
    values.emplace_back("shadow_map_size", "16");
    if (values.front().first != "lights") values.emplace_back("lights", "1");
    return picture(renderer,
                   settings(kOddWidth, kOddHeight, Term::direct, {technique("subtractive_shadows", values)}));
  }
  static vec3 middle(const Image& image) {
    return {image.at(kOddWidth / 2, kOddHeight / 2, 0), image.at(kOddWidth / 2, kOddHeight / 2, 1),
            image.at(kOddWidth / 2, kOddHeight / 2, 2)};
  }

  /// A floor whose shading normals are turned by that angle, below light of 1: its middle is seen along the
  /// normal of its triangles, and mirrors what comes at twice the angle.
  static scene::Scene turnedFloor(const scene::Material& material, float degrees) {
    scene::Scene scene = floorOf(material, uniform(1));
    const float angle = glm::radians(degrees);
    scene.meshes[0].primitives[0].normals.assign(4, {std::sin(angle), std::cos(angle), 0});
    return scene;
  }

  /// Returns what the middle of a scene reflects in the picture of each pass that reflects the environment as
  /// a whole, with the pass's name; the first channel.
  static std::vector<std::pair<std::string, float>> lightsOf(const scene::Scene& scene) {
    const auto whole = [](render::Renderer& of, std::vector<render::TechniqueUse> techniques) {
      return middle(picture(of, settings(kOddWidth, kOddHeight, Term::direct, std::move(techniques)))).x;
    };
    scene::Scene ratio = lit(scene, scene.environment, 0.05);
    ratio.environment.shadowedByRatio = true;
    render::Renderer renderer(device(), scene), byRatio(device(), ratio);
    std::vector<std::pair<std::string, float>> lights{
        {"core", whole(renderer, {})},
        {"core, by ratio", whole(byRatio, {})},
        {"prefiltered_environment",
         whole(renderer, {technique("prefiltered_environment", {{"size", "128"}})})}};
    for (const char* unshadowed : {"prefiltered", "cache"})
      lights.emplace_back(unshadowed, middle(light(renderer, unshadowed)).x);
    lights.emplace_back("brdf_samples",
                        middle(light(renderer, "brdf_samples", {{"brdf_samples", "1024"}})).x);
    return lights;
  }

  static void expectNear(vec3 value, vec3 expected, float tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], tolerance * expected[c]) << c;
  }
  static glsl::SurfaceBrdf brdfOf(const scene::Material& m) {
    return glsl::surface_brdf(vec3(m.baseColour), m.metallic, m.roughness, m.specularFactor, m.specularColour,
                              m.ior);
  }
};

TEST_F(UnshadowedEnvironmentTest, UniformLightGivesTheReflectance) {
  for (const float roughness : kRoughnesses) {
    const scene::Material material = metal(roughness);
    const scene::Scene scene = floorOf(material, uniform(2));
    render::Renderer renderer(device(), scene);
    const glsl::SurfaceBrdf s = brdfOf(material);
    const vec3 expected = 2.f * glsl::ltc_specular_reflectance(s, glsl::ltc_lookup(1, s.alpha));
    for (const char* samples : {"1", "32"}) {
      expectNear(middle(light(renderer, "brdf_samples", {{"brdf_samples", samples}})), expected, 2e-3f);
      expectNear(middle(light(renderer, "cache", {{"brdf_samples", samples}})), expected, 2e-3f);
    }
  }
}

/// In proportion to what they reflect, up to full_reflectance.
TEST_F(UnshadowedEnvironmentTest, LobesThatReflectLessHaveFewerSamples) {
  const scene::Material material = metal(kRoughnesses[1], vec3(0.4f));
  const scene::Scene scene = floorOf(material, sky());
  render::Renderer renderer(device(), scene);
  const auto reflected = [&renderer](int samples, const char* full) {
    return middle(light(renderer, "brdf_samples",
                        {{"brdf_samples", std::to_string(samples)}, {"full_reflectance", full}}));
  };
  const glsl::SurfaceBrdf s = brdfOf(material);
  const float reflectance = glsl::ltc_specular_reflectance(s, glsl::ltc_lookup(1, s.alpha)).x;
  const vec3 ofAll = reflected(64, "0");
  EXPECT_EQ(reflected(64, "0.25"), ofAll);
  for (const auto& [full, name] : {std::pair{0.5f, "0.5"}, {1.f, "1"}}) {
    const vec3 fewer = reflected(64, name);
    EXPECT_EQ(fewer, reflected(static_cast<int>(std::ceil(64 * reflectance / full)), "0")) << full;
    EXPECT_NE(fewer, ofAll) << full;
  }
}

/// The smoothest metal shows the light along the mirror direction, a rougher one the sum over its lobe.
/// Texels that cover as much as one of 32 samples of the widest lobe blur the slope of the light by 6 % of
/// all light.
TEST_F(UnshadowedEnvironmentTest, LinearLightGivesTheLobesMean) {
  constexpr int kSum = 8192;
  for (const float roughness : kRoughnesses) {
    const scene::Material material = metal(roughness, vec3(1));
    const glsl::SurfaceBrdf s = brdfOf(material);
    float up = 0;  // integral of the lobe times the cosine with the normal
    float all = 0;
    for (int i = 0; i < kSum; ++i) {
      const glsl::LobeSample l =
          glsl::lobe_sample(s.alpha, vec3(0, 0, 1), vec2(glsl::lobe_point(i, kSum)), kSum);
      up += l.weight * l.direction.z / kSum;
      all += l.weight / kSum;
    }
    if (roughness == kSmooth) {
      EXPECT_NEAR(up, 1, 1e-3f);
    }
    const vec3 expected = vec3(all) + vec3(0, 0.8f * up, 0);
    const scene::Scene scene = floorOf(material, test::environmentOf(512, linear));
    render::Renderer renderer(device(), scene);
    for (const char* unshadowed : {"brdf_samples", "cache"})
      expectNear(middle(light(renderer, unshadowed)), expected, 0.01f + 0.06f * s.alpha);
  }
}

TEST_F(UnshadowedEnvironmentTest, SurfacesWithoutALobeHaveTheLightOfFilteredMaps) {
  scene::Material matte = metal(1);
  matte.metallic = 0;
  matte.specularFactor = 0;
  const scene::Scene scene = floorOf(matte, sky());
  render::Renderer renderer(device(), scene);
  const Image expected = light(renderer, "prefiltered");
  for (const char* unshadowed : {"brdf_samples", "cache"})
    EXPECT_EQ(rmse(light(renderer, unshadowed), expected), 0);
}

TEST_F(UnshadowedEnvironmentTest, MoreSamplesConverge) {
  for (const float roughness : {51 / 255.f, 153 / 255.f}) {
    const scene::Scene scene = floorOf(metal(roughness), sky());
    render::Renderer renderer(device(), scene);
    const auto sampled = [&](const char* samples) {
      return light(renderer, "brdf_samples", {{"brdf_samples", samples}});
    };
    const Image exact = sampled("1024");
    const double few = rmse(sampled("8"), exact), some = rmse(sampled("32"), exact),
                 many = rmse(sampled("128"), exact);
    EXPECT_LT(some, few);
    EXPECT_LT(many, some);
    EXPECT_LT(many, 0.05 * mean(exact));
  }
}

/// The widest of these lobes, of alpha 0.03, has its middle 30 degrees above the floor or below it: of its
/// normals alpha^2 / (alpha^2 + tan(15 degrees)^2), 0.0124, lie further out, less than half of them on the
/// other side of the floor.
TEST_F(UnshadowedEnvironmentTest, SmoothSurfacesMirrorNothingFromBelowTheirTriangle) {
  const auto model = [](uint32_t kind) {
    glsl::MaterialModel m{};
    m.kind = kind;
    m.ks = vec3(1);
    m.eta = vec3(1e-3f);
    m.k = vec3(1000);
    m.exponent = 1000;
    m.roughness = vec2(0.03f);
    return m;
  };
  std::vector<scene::Material> materials{metal(kSmooth, vec3(1))};
  for (const uint32_t kind : {glsl::model_coated, glsl::model_phong, glsl::model_torrance_sparrow})
    scene::setModel(materials.emplace_back(), model(kind));
  constexpr float kBound = 0.007f;
  for (const scene::Material& material : materials) {
    SCOPED_TRACE(material.model ? material.model->kind : glsl::model_none);
    for (const auto& [name, value] : lightsOf(turnedFloor(material, 30))) EXPECT_GT(value, 0.9f) << name;
    const scene::Scene scene = turnedFloor(material, 60);
    for (const auto& [name, value] : lightsOf(scene)) EXPECT_NEAR(value, 0, kBound) << name;
    EXPECT_NEAR(middle(reference(scene, settings(kOddWidth, kOddHeight, Term::direct), 64)).x, 0, kBound);
  }
}

/// Of rough surfaces what lies above the triangle is left, against the sum over the lobe. What the table of
/// linearly transformed cosines gives, computed on the processor, is within 0.006 of it here, and 1024
/// samples that the triangle's plane cuts within 0.003.
TEST_F(UnshadowedEnvironmentTest, RoughSurfacesReflectWhatIsAboveTheirTriangle) {
  constexpr int kSum = 8192;
  for (const float roughness : {51 / 255.f, 153 / 255.f, 1.f})
    for (const float degrees : {30.f, 50.f, 60.f}) {
      const scene::Material material = metal(roughness, vec3(1));
      const scene::Scene scene = turnedFloor(material, degrees);
      const vec3 v(0, 1, 0), n = scene.meshes[0].primitives[0].normals[0];
      const glsl::Frame frame = glsl::frame_towards(n, v);
      const float alpha = brdfOf(material).alpha;
      float expected = 0;
      for (int i = 0; i < kSum; ++i) {
        const glsl::LobeSample l =
            glsl::lobe_sample(alpha, glsl::to_local(frame, v), vec2(glsl::lobe_point(i, kSum)), kSum);
        if (glsl::from_local(frame, l.direction).y > 0) expected += l.weight / kSum;
      }
      for (const auto& [name, value] : lightsOf(scene))
        EXPECT_NEAR(value, expected, 0.01f) << name << ' ' << roughness << ' ' << degrees;
    }
}

/// Against samples of the environment, which know no lobes.
TEST_F(UnshadowedEnvironmentTest, LobesOfModelsConvergeToSamplesOfTheEnvironment) {
  const auto model = [](uint32_t kind) {
    glsl::MaterialModel m{};
    m.kind = kind;
    m.kd = vec3(0.3f, 0.2f, 0.1f);
    m.ks = vec3(0.5f);
    m.eta = vec3(1.5f);
    m.k = vec3(3);
    m.exponent = 12;
    m.roughness = vec2(0.4f, 0.4f);
    return m;
  };
  for (const uint32_t kind : {glsl::model_torrance_sparrow, glsl::model_ward, glsl::model_phong}) {
    scene::Material material;
    scene::setModel(material, model(kind));
    const scene::Scene scene = floorOf(material, sky());
    render::Renderer renderer(device(), scene);
    const Image exact = light(renderer, "lights", {{"lights", "64"}, {"unshadowed_factor", "64"}});
    EXPECT_LT(rmse(light(renderer, "brdf_samples", {{"brdf_samples", "256"}}), exact), 0.02 * mean(exact))
        << kind;
    expectNear(middle(light(renderer, "cache", {{"brdf_samples", "256"}})), middle(exact), 0.03f);
  }
}

/// Materials with a model have the filtered maps' light of the surface next to them: of Banks's diffuse
/// coefficient 8/3, and of a weak lobe what such a surface reflects head-on.
TEST_F(UnshadowedEnvironmentTest, FilteredMapsLightModelsByTheirAlbedo) {
  glsl::MaterialModel banks{}, phong{};
  banks.kind = glsl::model_banks;
  banks.kd = vec3(0.3f, 0.2f, 0.1f);
  banks.exponent = 20;
  phong.kind = glsl::model_phong;
  phong.ks = vec3(0.04f);
  phong.exponent = 100;
  for (const glsl::MaterialModel& model : {banks, phong}) {
    scene::Material material;
    scene::setModel(material, model);
    const glsl::SurfaceBrdf s = glsl::nearest_brdf(model, brdfOf(material).alpha);
    const vec3 expected = model.kind == glsl::model_banks
                              ? 8.f / 3 * banks.kd
                              : glsl::ltc_specular_reflectance(s, glsl::ltc_lookup(1, s.alpha));
    EXPECT_GT(expected.x, 0.01f);
    const scene::Scene scene = floorOf(material, uniform(1));
    render::Renderer renderer(device(), scene);
    expectNear(middle(picture(renderer, settings(kOddWidth, kOddHeight, Term::direct))), expected, 0.02f);
    expectNear(middle(light(renderer, "prefiltered")), expected, 0.02f);
  }
}

/// One texel of 1e6, also next to a pole, and maps of one texel: samples look beyond the last level, or at
/// the first.
TEST_F(UnshadowedEnvironmentTest, ExtremesStayFinite) {
  std::vector<scene::Environment> environments(1);
  environments[0].width = environments[0].height = 1;
  environments[0].texels = {vec3(1e6f)};
  for (const int row : {0, 20}) {
    environments.push_back(test::environmentOf(256, [](vec3) { return vec3(0); }));
    environments.back().texels[static_cast<size_t>(row) * 256 + 77] = vec3(1e6f);
  }
  for (const scene::Environment& environment : environments) {
    for (const float roughness : {kSmooth, 1.f}) {
      const scene::Scene scene = floorOf(metal(roughness), environment);
      render::Renderer renderer(device(), scene);
      for (const char* samples : {"1", "256"})
        for (const char* unshadowed : {"brdf_samples", "cache"})
          expectWithin(light(renderer, unshadowed, {{"brdf_samples", samples}}), 0, 1.01e6f);
    }
  }
}

/// Half floats end at 65504, the radiance of maps at 1e12.
TEST_F(UnshadowedEnvironmentTest, FilteredMapsHoldTheBrightestLight) {
  scene::Material matte = metal(1, vec3(1)), coated;
  matte.metallic = 0;
  matte.specularFactor = 0;
  glsl::MaterialModel coat{};
  coat.kind = glsl::model_coated;
  coat.eta = vec3(1.5f);
  scene::setModel(coated, coat);
  const scene::Material smooth = metal(0.3f, vec3(1));
  const glsl::SurfaceBrdf s = brdfOf(smooth);
  const struct {
    const char* name;
    const scene::Material& material;
    float reflectance;
  } surfaces[] = {{"metal", smooth, glsl::ltc_specular_reflectance(s, glsl::ltc_lookup(1, s.alpha)).x},
                  {"coat", coated, 0.04f},
                  {"white", matte, 1}};
  for (const float bright : {1e5f, scene::kMostEnvironmentRadiance})
    for (const auto& surface : surfaces) {
      const scene::Scene plain = floorOf(surface.material, uniform(bright));
      scene::Scene ratio = lit(plain, plain.environment, 0.05);
      ratio.environment.shadowedByRatio = true;
      const auto expectBright = [&](const char* by, const Image& image) {
        EXPECT_NEAR(middle(image).x / bright, surface.reflectance, 0.01f * surface.reflectance)
            << surface.name << " by " << by << " under " << bright;
      };
      render::Renderer renderer(device(), plain), byRatio(device(), ratio);
      const render::Settings direct = settings(kOddWidth, kOddHeight, Term::direct);
      expectBright("core", picture(renderer, direct));
      expectBright("core, by ratio", picture(byRatio, direct));
      expectBright("subtractive_shadows", light(renderer, "prefiltered"));
    }
}

/// What the cache leaves out is that all surfaces have the view in the middle of the picture: from far away
/// they do.
TEST_F(UnshadowedEnvironmentTest, TheCacheIsExactForDistantViews) {
  scene::Scene scene;
  scene::Node node;
  node.mesh = test::addMesh(scene, test::spherePrimitive(1, test::addMaterial(scene, metal(153 / 255.f))));
  scene.nodes.push_back(node);
  scene.environment = sky();
  render::Renderer renderer(device(), scene);
  const auto seenFrom = [&](float distance, const char* unshadowed) {
    renderer.configure(settings(
        kOddWidth, kOddWidth, Term::direct,
        {technique("subtractive_shadows", {{"unshadowed", unshadowed}, {"lights", "1"}, {"bias", "64"}})}));
    renderer.setCamera(scene::lookAt({0, 0, distance}, {0, 0, 0}, 2.2f / distance));
    renderer.render();
    return renderer.read();
  };
  const auto error = [&](float distance) {
    const Image exact = seenFrom(distance, "brdf_samples");
    return rmse(seenFrom(distance, "cache"), exact) / mean(exact);
  };
  const double far = error(100);
  EXPECT_LT(far, 0.05);
  EXPECT_GT(error(3), 2 * far);
}

TEST_F(UnshadowedEnvironmentTest, TheCacheIsKeptUntilTheViewChanges) {
  const scene::Scene scene = floorOf(metal(153 / 255.f), sky());
  render::Renderer renderer(device(), scene);
  render::Settings kept = settings(
      kOddWidth, kOddHeight, Term::direct,
      {technique("subtractive_shadows", {{"unshadowed", "cache"}, {"lights", "1"}, {"block", "2"}})});
  kept.dynamic = false;
  renderer.configure(kept);
  const auto state = [&] {
    renderer.render();
    for (const frame::PassReport& row : renderer.explain())
      if (row.name == "radiance cache") return row.state;
    return frame::PassState::leftOut;
  };
  EXPECT_EQ(state(), frame::PassState::run);
  EXPECT_EQ(state(), frame::PassState::cached);
  renderer.setCamera(scene::lookAt({0, 3, 1}, {0, 0, 0}, 1));
  EXPECT_EQ(state(), frame::PassState::run);
  EXPECT_EQ(state(), frame::PassState::cached);
}

TEST_F(UnshadowedEnvironmentTest, MaterialsThatDoNotFitTheCacheHaveTheLightOfFilteredMaps) {
  scene::Scene scene = floorOf(metal(1), sky());
  for (int i = 0; i <= 128; ++i) {
    scene.materials.push_back(metal(0.2f + 0.001f * static_cast<float>(i)));
    addBelow(scene, i + 1);
  }
  for (const int place : {127, 128}) {
    scene.meshes[0].primitives[0].material = place + 1;
    render::Renderer renderer(device(), scene);
    EXPECT_EQ(rmse(light(renderer, "cache"), light(renderer, "prefiltered")) == 0, place == 128);
  }
}

/// Places are taken by what is drawn, one for each roughness: colours are the pixels' own.
TEST_F(UnshadowedEnvironmentTest, TheCacheHasAPlaceForEachRoughness) {
  constexpr float kRoughness = 51 / 255.f;
  scene::Scene scene = floorOf(metal(kRoughness), sky());
  Image shown;
  const auto bytes = [&]() -> int64_t {
    render::Renderer renderer(device(), scene);
    shown = light(renderer, "cache");
    for (const frame::PassReport& row : renderer.explain())
      if (row.name == "radiance cache") return row.bytes;
    return 0;
  };
  const int64_t one = bytes();
  EXPECT_GT(one, 0);
  scene.materials.push_back(metal(0.7f));
  EXPECT_EQ(bytes(), one) << "nothing is drawn with the second material";
  addBelow(scene, 1);
  EXPECT_EQ(bytes(), 2 * one);
  const Image apart = shown;
  scene.materials.insert(scene.materials.begin(), metal(kRoughness, {0.1f, 0.2f, 1}));
  scene.meshes[0].primitives[0].material = 1;  // the floor's own is second now
  scene.meshes[1].primitives[0].material = 0;
  EXPECT_EQ(bytes(), one) << "both have one roughness";
  EXPECT_EQ(rmse(shown, apart), 0);
}

}  // namespace
}  // namespace limn
