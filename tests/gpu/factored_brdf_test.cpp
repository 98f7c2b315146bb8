// Tabulated materials against the exact model, as both are drawn.
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/brdf/model_brdf.h"
#include "core/frame/program_report.h"
#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "glsl/materials/model.glsl"
#include "tests/gpu/render_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using Choice = std::vector<std::pair<std::string, std::string>>;

class FactoredBrdfTest : public RenderTest {
 protected:
  /// A ball under a light from the side and one from behind the camera.
  static scene::Scene ball(float roughness, uint32_t kind = glsl::model_torrance_sparrow) {
    return balls({copper(roughness, kind)});
  }
  static glsl::MaterialModel copper(float roughness, uint32_t kind = glsl::model_torrance_sparrow) {
    glsl::MaterialModel model{};
    model.kind = kind;
    model.eta = {0.2f, 0.92f, 1.1f};
    model.k = {3.91f, 2.45f, 2.14f};
    model.ks = glm::vec3(0.5f);
    model.kd = glm::vec3(0.1f);
    model.exponent = 20;
    model.roughness = glm::vec2(roughness);
    return model;
  }
  /// Balls beside each other, together as wide as one, after a material without a model.
  static scene::Scene balls(const std::vector<glsl::MaterialModel>& models) {
    scene::Scene scene;
    test::addMaterial(scene, scene::Material{});
    const float radius = 1 / static_cast<float>(models.size());
    for (size_t i = 0; i < models.size(); ++i) {
      scene::Material material;
      material.name = "ball " + std::to_string(i);
      scene::setModel(material, models[i]);
      scene::Node node;
      node.mesh = test::addMesh(scene, test::spherePrimitive(radius, test::addMaterial(scene, material)));
      node.transform.translation.x = radius * (2 * static_cast<float>(i) + 1) - 1;
      scene.nodes.push_back(node);
    }
    for (const glm::vec3& direction : {glm::vec3(-1, -1, -0.4f), glm::vec3(0.5f, -0.3f, -1)}) {
      scene::LightSource light;
      light.type = glsl::light_directional;
      light.intensity = 2;
      scene::Node lamp;
      lamp.transform.rotation = glm::quatLookAt(glm::normalize(direction), glm::vec3(0, 1, 0));
      lamp.light = static_cast<int>(scene.lights.size());
      scene.lights.push_back(light);
      scene.nodes.push_back(lamp);
    }
    return scene;
  }

  static Image drawn(render::Renderer& renderer, const std::vector<render::TechniqueUse>& techniques) {
    renderer.configure(settings(96, 96, Term::direct, techniques));
    renderer.setCamera(scene::lookAt({0.3f, 0.8f, 3}, {0, 0, 0}, 0.8f));
    renderer.render();
    return renderer.read();
  }

  /// RMS of the difference over RMS of the exact picture.
  static double errorOf(const Image& tables, const Image& exact) {
    double difference = 0, sum = 0;
    for (size_t i = 0; i < exact.data().size(); ++i) {
      const double d = static_cast<double>(tables.data()[i]) - static_cast<double>(exact.data()[i]);
      EXPECT_TRUE(std::isfinite(tables.data()[i]));
      difference += d * d;
      sum += static_cast<double>(exact.data()[i]) * static_cast<double>(exact.data()[i]);
    }
    EXPECT_GT(sum, 0);
    return std::sqrt(difference / sum);
  }

  /// Errors of a scene by tables, against one exact picture.
  class Errors {
   public:
    explicit Errors(scene::Scene scene)
        : scene_(std::move(scene)), renderer_(device(), scene_), exact_(drawn(renderer_, {})) {}
    double of(const Choice& values) {
      return errorOf(drawn(renderer_, {technique("factored_brdf", values)}), exact_);
    }

   private:
    const scene::Scene scene_;
    render::Renderer renderer_;
    const Image exact_;
  };
  static double error(const scene::Scene& scene, const Choice& values) { return Errors(scene).of(values); }
};

TEST_F(FactoredBrdfTest, WarpedTablesAreThePublishedOnesAFiftiethWrong) {
  Errors errors(ball(0.1f));
  const double warped = errors.of({{"texels", "128"}, {"format", "float32"}});
  const double published =
      errors.of({{"texels", "128"}, {"format", "float32"}, {"coordinates", "published"}});
  EXPECT_LT(warped, 3e-3);
  EXPECT_GT(published, 50 * warped);
  EXPECT_LT(errors.of({{"texels", "128"}, {"format", "half"}}), 3e-3);
}

/// A ball hides the side light from half of a highlight, and a rectangle lights the scene by points.
TEST_F(FactoredBrdfTest, TablesErrAsLittleUnderEveryShadowTechnique) {
  glsl::MaterialModel brushed = copper(0.1f, glsl::model_ward);
  brushed.roughness.y = 0.4f;
  scene::Scene scene = balls({copper(0.1f), brushed});
  scene::Node blocker, lamp;
  blocker.mesh = test::addMesh(scene, test::spherePrimitive(0.2f, 0));
  blocker.transform.translation = {0.31f, 0.87f, 0.4f};
  scene.nodes.push_back(blocker);
  scene::LightSource rectangle;
  rectangle.type = glsl::light_point;
  rectangle.intensity = 20;
  lamp.limnArea = {1, 0.6f};
  lamp.transform.translation = {2, 1.5f, 1};
  lamp.transform.rotation = glm::quatLookAt(glm::normalize(glm::vec3(-2, -1.5f, -1)), glm::vec3(0, 1, 0));
  lamp.light = static_cast<int>(scene.lights.size());
  scene.lights.push_back(rectangle);
  scene.nodes.push_back(lamp);
  render::Renderer renderer(device(), scene);
  const double unshadowed = mean(drawn(renderer, {}));
  for (const Term term : {Term::visibility, Term::direct})
    for (const std::string& name : techniquesAnswering(term)) {
      const render::TechniqueUse use = smallest(name, 64, 128);  // both pictures have the same maps
      const Image exact = drawn(renderer, {use});
      const double shadowed = errorOf(drawn(renderer, {use, technique("factored_brdf")}), exact);
      RecordProperty(name, std::to_string(shadowed) + " " + std::to_string(mean(exact) / unshadowed));
      EXPECT_LT(shadowed, 3e-3) << name;
      if (term == Term::visibility) {
        EXPECT_LT(mean(exact), 0.97 * unshadowed) << name;
      }
    }
}

TEST_F(FactoredBrdfTest, OtherModelsAreExact) {
  EXPECT_EQ(error(ball(0.3f, glsl::model_phong), {{"texels", "2"}}), 0);
  glsl::MaterialModel printed = copper(0.3f, glsl::model_banks);
  printed.options = glsl::model_option_printed;
  EXPECT_EQ(error(balls({printed}), {{"texels", "2"}}), 0);
}

/// Brushed metal and fibres, by tables of their own beside those of other models and behind each other.
TEST_F(FactoredBrdfTest, ModelsThatTurnWithTheTangentHaveTables) {
  glsl::MaterialModel brushed = copper(0.1f, glsl::model_ward), fibres = copper(0, glsl::model_banks);
  brushed.roughness.y = 0.4f;
  fibres.kd = glm::vec3(0.05f, 0.1f, 0.2f);
  glsl::MaterialModel across = brushed, independent = brushed, hair = fibres;
  std::swap(across.roughness.x, across.roughness.y);
  independent.options = glsl::model_option_product;
  hair.exponent = 4;
  Errors ofBrushed(balls({brushed})), ofFibres(balls({fibres}));
  Errors ofMixed(balls({brushed, fibres, copper(0.3f), across, hair, copper(0.2f), independent,
                        copper(0.3f, glsl::model_phong)}));
  for (const char* format : {"float32", "half"}) {
    EXPECT_LT(ofBrushed.of({{"format", format}}), 3e-3) << format;
    EXPECT_LT(ofFibres.of({{"format", format}}), 3e-3) << format;
    EXPECT_LT(ofMixed.of({{"format", format}}), 3e-3) << format;
  }
  EXPECT_GT(ofBrushed.of({{"texels", "32"}}), 5 * ofBrushed.of({{"texels", "128"}}));
  EXPECT_LT(ofBrushed.of({{"coordinates", "published"}}), 0.01);
  for (const char* coordinates : {"warped", "published"})
    ofMixed.of({{"texels", "2"}, {"format", "byte"}, {"coordinates", coordinates}});
}

/// At an index of 5 and where light grazes the microfacets, Schlick's reflectance is off by a quarter.
TEST_F(FactoredBrdfTest, SchlicksReflectanceErrsMoreThanTheTables) {
  for (const uint32_t kind : {glsl::model_torrance_sparrow, glsl::model_ward}) {
    glsl::MaterialModel dense = copper(0.2f, kind);
    dense.eta = glm::vec3(5);
    dense.k = glm::vec3(0);
    scene::Scene scene = balls({dense});
    scene.lights[0].intensity = 0;
    scene.nodes.back().transform.rotation =
        glm::quatLookAt(glm::normalize(glm::vec3(-0.4f, 0, 0.92f)), glm::vec3(0, 1, 0));  // from behind
    Errors errors(scene);
    const double schlick = errors.of({{"fresnel", "schlick"}});
    EXPECT_GT(schlick, 0.05) << kind;
    EXPECT_GT(schlick, 20 * errors.of({{"fresnel", "exact"}})) << kind;
  }
}

TEST_F(FactoredBrdfTest, ExtremesAreFinite) {
  for (const float roughness : {0.f, 1e-3f, 1.f}) {
    Errors errors(ball(roughness));
    for (const char* format : {"float32", "half", "byte"}) errors.of({{"texels", "2"}, {"format", format}});
  }
  Errors errors(ball(1e-3f));
  for (const char* fit : {"tables", "dfg", "pqp", "pqp_disc", "svd", "trilinear"})
    errors.of({{"fit", fit}, {"fit_texels", "2"}, {"format", "byte"}});
  for (const char* fit : {"pqp", "dfg_disc"})
    errors.of({{"fit", fit}, {"terms", "2"}, {"fit_texels", "2"}, {"format", "byte"}});
}

/// Roughness 0 is the narrowest lobe that there is; tables of 2 texels spread its peak over the ball.
TEST_F(FactoredBrdfTest, LightsAsBrightAsTheSunGiveTheSamePictureAsDimOnes) {
  scene::Scene sunlit = ball(0), dim = sunlit;
  for (scene::LightSource& light : sunlit.lights) light.intensity = 1e5f;
  for (scene::LightSource& light : dim.lights) light.intensity = 2;
  render::Renderer underSuns(device(), sunlit), underLamps(device(), dim);
  for (const char* texels : {"2", "16"}) {
    const auto under = [&](render::Renderer& lights) {
      return drawn(lights, {technique("factored_brdf", {{"texels", texels}, {"format", "half"}})});
    };
    const Image bright = under(underSuns);
    Image expected = under(underLamps);
    for (float& value : expected.data()) value *= 5e4f;
    EXPECT_LE(errorOf(bright, expected), 1e-3)
        << texels << " texels, in the mean " << mean(bright) << " for " << mean(expected);
  }
}

/// Each fit against the exact model, by the error that it has in a picture on the CPU. That one has grazing
/// lights, and this one few.
TEST_F(FactoredBrdfTest, FitsAreAsExactAsTheySay) {
  const scene::Scene scene = ball(0.3f);
  Errors errors(scene);
  const glsl::MaterialModel model = *scene.materials.back().model;
  const std::tuple<const char*, brdf::Factorisation, int, int> fits[] = {
      {"tables", brdf::Factorisation::tables, 128, 1},
      {"dfg", brdf::Factorisation::dfg, 64, 1},
      {"pqp", brdf::Factorisation::pqp, 64, 1},
      {"pqp_disc", brdf::Factorisation::pqp_disc, 32, 1},
      {"dfg_disc", brdf::Factorisation::dfg_disc, 32, 1},
      {"dfg", brdf::Factorisation::dfg, 64, 2},
      {"dfg_disc", brdf::Factorisation::dfg_disc, 32, 2},
      {"svd", brdf::Factorisation::svd, 24, 4},
      {"trilinear", brdf::Factorisation::trilinear, 32, 1}};
  for (const auto& [name, factorisation, texels, terms] : fits) {
    brdf::FitSettings fit;
    fit.factorisation = factorisation;
    fit.texels = texels;
    fit.terms = terms;
    fit.samples = 8000;
    const double own = brdf::fitModel(model, {}, fit)->error;
    const double found = errors.of({{"fit", name}, {"terms", std::to_string(terms)}});
    RecordProperty(name, std::to_string(own) + " " + std::to_string(found));
    // Weights of linear filtering have 8 bits on GPUs: at a logarithm's steepest that is 2e-3 more.
    EXPECT_LE(found, 1.5 * own + 2e-3) << name << ' ' << terms;
  }
  EXPECT_LE(errors.of({{"fit", "dfg"}}), 0.01);
  EXPECT_EQ(errors.of({{"fit", "exact"}}), 0);
}

/// A fit is looked up behind those of the materials before it; equal materials share one, and black ones and
/// those that a fit cannot hold are exact.
TEST_F(FactoredBrdfTest, MaterialsHaveTablesOfTheirOwn) {
  glsl::MaterialModel brushed = copper(0.2f, glsl::model_ward), black = copper(0.2f);
  brushed.roughness.y = 0.4f;
  black.ks = black.kd = glm::vec3(0);
  Errors errors(
      balls({copper(0.3f), copper(0.5f), black, copper(0.3f), brushed, copper(0.4f, glsl::model_ward)}));
  // On the CPU the worst of these balls has 0.001, 0.006, 0.005, 0.013 and 0.064, most by the brushed one.
  for (const char* name : {"tables", "dfg"}) EXPECT_LE(errors.of({{"fit", name}}), 0.01) << name;
  for (const char* name : {"pqp", "trilinear"}) EXPECT_LE(errors.of({{"fit", name}}), 0.015) << name;
  EXPECT_LE(errors.of({{"fit", "pqp_disc"}}), 0.025);
  EXPECT_LE(errors.of({{"fit", "dfg_disc"}, {"terms", "2"}}), 0.025);
  EXPECT_LE(errors.of({{"fit", "svd"}, {"terms", "4"}}), 0.08);
}

/// They have the tables and the program of one choice with the other.
TEST_F(FactoredBrdfTest, FitsThatLieOverNoCoordinatesAreTheSameWithAny) {
  const scene::Scene scene = ball(0.3f);
  render::Renderer renderer(device(), scene);
  for (const char* fit : {"dfg", "pqp", "svd", "trilinear"}) {
    const auto with = [&](const char* coordinates) {
      return drawn(renderer, {technique("factored_brdf",
                                        {{"fit", fit}, {"fit_texels", "4"}, {"coordinates", coordinates}})});
    };
    const Image warped = with("warped");
    const int64_t compiled = device().counters().programsCompiled;
    EXPECT_EQ(rmse(with("published"), warped), 0) << fit;
    EXPECT_EQ(device().counters().programsCompiled, compiled) << fit;
  }
}

TEST_F(FactoredBrdfTest, SaysWhichMaterialsAreExact) {
  glsl::MaterialModel brushed = copper(0.2f, glsl::model_ward);
  brushed.roughness.y = 0.4f;
  const scene::Scene scene = balls({copper(0.3f), brushed});
  render::Renderer renderer(device(), scene);
  for (const char* name : {"trilinear", "svd"}) {
    renderer.configure(
        settings(48, 36, Term::direct, {technique("factored_brdf", {{"fit", name}, {"fit_texels", "2"}})}));
    renderer.setCamera(scene::lookAt({0.3f, 0.8f, 3}, {0, 0, 0}, 0.8f));
    renderer.render();
    bool listed = false;
    for (const frame::PassReport& pass : renderer.explain())
      listed = listed || (pass.name == "tables of ball 1" && pass.state == frame::PassState::leftOut);
    EXPECT_EQ(listed, std::string(name) == "trilinear");
  }
}

/// A scene without models keeps its picture and its programs.
TEST_F(FactoredBrdfTest, IsLeftOutWhereNoMaterialHasAModel) {
  const scene::Scene scene = asset("cornell_box");
  struct Drawn {
    Image image;
    std::vector<gpu::ProgramDesc> programs;
    bool leftOut = false;
  };
  const auto drawnWith = [&](std::vector<render::TechniqueUse> techniques) {
    render::Renderer renderer(device(), scene);
    Drawn result{picture(renderer, settings(48, 36, Term::final, std::move(techniques))), {}};
    for (const frame::ProgramReport& report : renderer.graph().programs())
      result.programs.push_back(report.desc);
    for (const frame::PassReport& pass : renderer.explain())
      result.leftOut =
          result.leftOut || (pass.technique == "factored_brdf" && pass.reason == "no material has a model");
    return result;
  };
  const Drawn without = drawnWith({}), with = drawnWith({technique("factored_brdf")});
  EXPECT_TRUE(with.leftOut);
  EXPECT_EQ(rmse(with.image, without.image), 0);
  EXPECT_FALSE(without.programs.empty());
  EXPECT_TRUE(with.programs == without.programs);
}

}  // namespace
}  // namespace limn
