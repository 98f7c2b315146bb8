// Every program that the values of a technique's parameters lead to is compiled, and none is run. The test
// glsl.conformance reads what is handed to the driver here.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/gpu/environment_harness.h"

namespace limn {
namespace {

/// Whole numbers up to this are tried: larger ones are sizes, which take memory and reach programs as numbers
/// of the same kind.
constexpr double kLargestNumber = 64;

/// Texels of tables whose size a technique chooses where none is asked for. It reaches programs as a number,
/// and what fits the tables takes longer than all programs do.
constexpr const char* kTableTexels = "8";

class PermutationTest : public EnvironmentTest {
 protected:
  using Uses = std::vector<render::TechniqueUse>;

  /// With long elements, where the technique cuts surfaces: programs do not depend on how many there are, and
  /// making them for each choice takes long.
  static render::TechniqueUse ofFewElements(render::TechniqueUse use) {
    if (cutsSurfaces(use.plugin->info->name)) use.parameters.set("longest_edge", "0.3");
    return use;
  }

  /// As quick, with small tables and few elements.
  static render::TechniqueUse quickest(const std::string& name) {
    render::TechniqueUse use = ofFewElements(quick(name));
    for (const Parameter& p : use.parameters.declared())
      if (p.type == ParameterType::integer && std::string_view(p.unit) == "texels" && p.defaultValue == 0)
        use.parameters.set(p.name, kTableTexels);
    return use;
  }

  /// All combinations of the values of choices and flags.
  static Uses combinations(const std::string& name) {
    Uses all{quickest(name)};
    for (const Parameter& parameter : registry().find(name).info->parameters) {
      std::vector<std::string> values(parameter.choices, parameter.choices + parameter.choiceCount);
      if (parameter.type == ParameterType::boolean) values = {"false", "true"};
      Uses wider;
      for (const std::string& value : values)
        for (const render::TechniqueUse& use : all)
          wider.emplace_back(use).parameters.set(parameter.name, value);
      if (!wider.empty()) all = std::move(wider);
    }
    return all;
  }

  /// The least and the largest value of each whole number, the others as they are by default.
  static Uses ends(const std::string& name) {
    Uses all;
    for (const Parameter& parameter : registry().find(name).info->parameters) {
      if (parameter.type != ParameterType::integer || std::string_view(parameter.unit) == "MiB") continue;
      for (const double end :
           {parameter.range.low, std::clamp(kLargestNumber, parameter.range.low, parameter.range.high)})
        all.emplace_back(quickest(name))
            .parameters.set(parameter.name, std::to_string(static_cast<int>(end)));
    }
    return all;
  }

  /// Where the technique has something to answer. The first scene sees all combinations; each of the others
  /// has lights, materials or a medium that core's programs depend on. Under an environment fresnel_spheres
  /// and disk_and_sphere have every model that prefiltered_environment has a lobe or an albedo for, and of
  /// translucent_spheres techniques are asked for light twice.
  static std::vector<std::string> scenesFor(const std::string& name) {
    const auto answers = [&](Term term) { return contains(registry().find(name).info->terms, term); };
    if (answers(Term::media) || answers(Term::caustic) || answers(Term::specular))
      return {"glass_sphere", "smoke", "stained_light", "glassware"};
    std::vector<std::string> scenes;
    if (answers(Term::visibility) || answers(Term::indirect))
      scenes = {"cornell_box", "lights", "stained_light", "glossy_sphere", "foliage_card"};
    if (answers(Term::surface))
      scenes.insert(scenes.end(), {"torus_metal", "disk_and_sphere", "teapot_groove"});
    if (registry().find(name).info->places) scenes = {"egg_crate", "bump_wall", "bump_sphere"};
    if (answers(Term::subsurface))
      scenes = {"translucent_edge", "translucent_spheres", "translucent_checker"};
    if (answers(Term::environment)) scenes.emplace_back("balls_sky");
    if (lightsByEnvironmentAlone(name))
      scenes.insert(scenes.end(), {"fresnel_spheres", "disk_and_sphere", "translucent_spheres"});
    return scenes;
  }

  static bool lightsByEnvironmentAlone(const std::string& name) {
    return registry().find(name).info->terms == termSet(Term::environment);
  }

  /// A scene as built; under a sky where the technique answers for nothing else and the scene has none.
  static scene::Scene sceneFor(const std::string& name, const std::string& file) {
    scene::Scene scene = asset(file);
    if (lightsByEnvironmentAlone(name) && !scene.environment) scene.environment = sky();
    return scene;
  }

  /// Compiles what the technique needs, unless it refuses values that do not go together, which `refusals`
  /// counts then.
  static void compile(render::Renderer& renderer, Term term, const Uses& uses, int* refusals = nullptr) {
    render::Settings asked = settings(48, 36, term, uses, isFactor(term) ? 0 : -1);
    asked.display.emplace();
    renderer.configure(std::move(asked));
    renderer.setCamera(renderer.pose().cameras.at(0));
    bool whole = false;
    try {
      whole = renderer.render(frame::Timing::off, [] { return true; });
    } catch (const UsageError& refusal) {
      if (refusals == nullptr)
        ADD_FAILURE() << refusal.what();
      else
        ++*refusals;
    }
    EXPECT_FALSE(whole) << "passes were executed";
  }

  /// Compiles what the technique needs with the values that its parameters have by default.
  static void compileDefaults(render::Renderer& renderer, const std::string& name) {
    const render::TechniqueUse use = ofFewElements(technique(name));
    compile(renderer, Term::final, {use});
    if (contains(registry().find(name).info->terms, Term::visibility) && !renderer.pose().lights.empty())
      compile(renderer, Term::visibility, {use});
  }
};

/// Techniques that look at one scene share its renderer, which compiles core's programs once; each has one of
/// its own for its combinations, which are many.
TEST_F(PermutationTest, EveryProgramCompiles) {
  // Names by file, and by lightsByEnvironmentAlone(), which the scene depends on.
  std::map<std::pair<std::string, bool>, std::vector<std::string>> others;
  for (const TechniquePlugin* plugin : testedTechniques()) {
    const std::string name = plugin->info->name;
    SCOPED_TRACE(name);
    const std::vector<std::string> scenes = scenesFor(name);
    if (scenes.empty()) continue;
    for (size_t i = 1; i < scenes.size(); ++i)
      others[{scenes[i], lightsByEnvironmentAlone(name)}].push_back(name);
    const scene::Scene scene = sceneFor(name, scenes.front());
    render::Renderer renderer(device(), scene);
    compileDefaults(renderer, name);
    Uses uses = combinations(name);
    std::ranges::move(ends(name), std::back_inserter(uses));
    int refusals = 0;
    for (const render::TechniqueUse& use : uses) compile(renderer, Term::final, {use}, &refusals);
    EXPECT_LT(refusals, static_cast<int>(uses.size()) / 2);
  }
  for (const auto& [where, names] : others) {
    SCOPED_TRACE(where.first);
    const scene::Scene scene = sceneFor(names.front(), where.first);
    render::Renderer renderer(device(), scene);
    for (const std::string& name : names) {
      SCOPED_TRACE(name);
      compileDefaults(renderer, name);
    }
  }
}

/// Of core: the environment's own light with the shadows of the lights that stand for it, in one batch of
/// them and in several, with shadows and without.
TEST_F(PermutationTest, EveryProgramOfEnvironmentSharesCompiles) {
  for (const char* file :
       {"balls_sky", "torus_metal", "fresnel_spheres", "translucent_spheres", "bump_sphere"})
    for (const double share : {0.001, 0.05}) {
      SCOPED_TRACE(file);
      scene::Scene scene = lit(asset(file), sky(), share);
      scene.environment.shadowedByRatio = true;
      render::Renderer renderer(device(), scene);
      compile(renderer, Term::final, {});
      compile(renderer, Term::final, {technique("hard_shadow_map")});
      compile(renderer, Term::final, {technique("hard_shadow_map"), technique("bump_horizon")});
    }
}

}  // namespace
}  // namespace limn
