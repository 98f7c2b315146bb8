// Fixture for tests that render whole frames with technique plug-ins.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"
#include "core/scene_io/load.h"
#include "core/technique/registry.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/paths.h"

namespace limn {
namespace test {

/// Returns a request to the reference for a term, of all lights; whoever asks for more sets it. The scene and
/// the pose must outlive it.
inline reference::Request request(const scene::Scene& scene, const scene::Pose& pose,
                                  const scene::CameraPose& camera, const glm::ivec2& size, Term term,
                                  int spp) {
  return {.scene = scene,
          .pose = pose,
          .camera = camera,
          .width = size.x,
          .height = size.y,
          .term = term,
          .spp = spp};
}

/// Returns the same for the pose of a renderer of that scene, from the scene's first camera.
inline reference::Request request(render::Renderer& renderer, const scene::Scene& scene,
                                  const glm::ivec2& size, Term term, int spp) {
  return request(scene, renderer.pose(), renderer.pose().cameras.at(0), size, term, spp);
}

}  // namespace test

/// Makes pictures, under each back end.
class PictureTest : public GlTest {
 protected:
  /// A scene of assets/, as built.
  static scene::Scene asset(const std::string& name) {
    return scene::load(std::filesystem::path(test::kBinaryDir) / "assets" / name / (name + ".glb"));
  }

  /// A scene of assets/ with about 20 vertices from side to side of each mesh of 3000 triangles or more.
  /// Pictures of a few thousand pixels show hardly less, and many shadow maps of it are drawn in a fraction
  /// of the time.
  static scene::Scene coarse(const std::string& name) {
    scene::Scene scene = asset(name);
    for (scene::Mesh& mesh : scene.meshes)
      for (scene::Primitive& primitive : mesh.primitives) coarsen(primitive);
    return scene;
  }

  static const TechniqueRegistry& registry() {
    static const std::vector<std::filesystem::path> folders = TechniqueRegistry::defaultFolders();
    static const TechniqueRegistry instance(folders);
    return instance;
  }

  /// A technique whose quality parameters are kept small, so that laws that hold at any quality are tested
  /// quickly.
  static render::TechniqueUse quick(const std::string& name, int lights = 64) {
    render::TechniqueUse use = technique(name);
    for (const Parameter& p : use.parameters.declared()) {
      if (!p.tradesErrorForTime) continue;
      const std::string_view unit(p.unit);
      // Of surface elements: as long as may be without losing whole objects.
      if (p.type == ParameterType::real && unit == "scene radii" && p.defaultValue < 0.1)
        use.parameters.set(p.name, "0.1");
      // Errors that are asked for: ten times as large.
      if (p.type == ParameterType::real && std::string_view(p.name).ends_with("_error"))
        use.parameters.set(p.name, std::to_string(std::min(10 * p.defaultValue, p.range.high)));
      if (p.type != ParameterType::integer) continue;
      const double most = unit == "texels" ? 512 : unit == "lights" ? lights : unit == "bins" ? 8 : 16;
      if (p.defaultValue > most && p.range.low <= most) use.parameters.set(p.name, std::to_string(int(most)));
    }
    return use;
  }

  /// As quick, with maps and buffers of at most that many texels a side, for laws that hold to the bit or
  /// whatever a picture shows: frames take a tenth of the time.
  static render::TechniqueUse smallest(const std::string& name, int lights = 64, int most = 64) {
    render::TechniqueUse use = quick(name, lights);
    for (const Parameter& p : use.parameters.declared())
      if (p.type == ParameterType::integer && std::string_view(p.name).ends_with("_size") &&
          std::string_view(p.unit) == "texels" && use.parameters.integer(p.name) > most)
        use.parameters.set(p.name, std::to_string(std::max(most, static_cast<int>(p.range.low))));
    return use;
  }

  /// A technique with some parameters set.
  static render::TechniqueUse technique(const std::string& name,
                                        const std::vector<std::pair<std::string, std::string>>& values = {}) {
    const TechniquePlugin& plugin = registry().find(name);
    render::TechniqueUse use{&plugin, ParameterValues(name, plugin.info->parameters)};
    for (const auto& [parameter, value] : values) use.parameters.set(parameter, value);
    return use;
  }

  /// Those under test: all, or the one that LIMN_TEST_TECHNIQUE names.
  static std::vector<const TechniquePlugin*> testedTechniques() {
    if (const char* name = std::getenv("LIMN_TEST_TECHNIQUE")) return {&registry().find(name)};
    // A law holds for none of those that could not be loaded.
    for (const TechniqueRegistry::Refusal& refusal : registry().refused()) throw Error(refusal.reason);
    return {registry().all().begin(), registry().all().end()};
  }

  static std::vector<std::string> techniquesAnswering(Term term) {
    std::vector<std::string> names;
    for (const TechniquePlugin* plugin : testedTechniques())
      if (contains(plugin->info->terms, term)) names.emplace_back(plugin->info->name);
    return names;
  }

  /// Whether the technique has nothing to answer in scenes without height maps.
  static bool lightsBumpsAlone(const std::string& name) { return registry().find(name).info->places; }

  /// Whether the technique cuts surfaces into elements, which takes long where triangles are many.
  static bool cutsSurfaces(const std::string& name) {
    return std::ranges::any_of(registry().find(name).info->parameters,
                               [](const Parameter& p) { return p.name == std::string_view("longest_edge"); });
  }

  /// Those with a picture of their own, and what shows it.
  static std::vector<std::pair<std::string, Term>> techniquesAndTerms() {
    std::vector<std::pair<std::string, Term>> all;
    for (const std::string& name : techniquesAnswering(Term::visibility))
      all.emplace_back(name, Term::visibility);
    for (const std::string& name : techniquesAnswering(Term::indirect))
      all.emplace_back(name, Term::indirect);
    return all;
  }

  /// The same techniques, each once.
  static std::vector<std::string> techniquesWithPictures() {
    std::vector<std::string> names;
    for (const auto& [name, term] : techniquesAndTerms())
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    return names;
  }

  static render::Settings settings(int width, int height, Term term,
                                   std::vector<render::TechniqueUse> techniques = {}, int light = -1) {
    render::Settings s;
    s.size = {width, height};
    s.term = term;
    s.techniques = std::move(techniques);
    s.light = light;
    return s;
  }

  /// One frame from a camera.
  static Image picture(render::Renderer& renderer, render::Settings s, const scene::CameraPose& camera) {
    renderer.configure(std::move(s));
    renderer.setCamera(camera);
    renderer.render();
    return renderer.read();
  }
  /// One frame from the scene's first camera.
  static Image picture(render::Renderer& renderer, render::Settings s) {
    return picture(renderer, std::move(s), renderer.pose().cameras.at(0));
  }

  static double rmse(const Image& a, const Image& b) {
    double sum = 0;
    for (size_t i = 0; i < a.data().size(); ++i) sum += std::pow(double(a.data()[i]) - b.data()[i], 2);
    return std::sqrt(sum / static_cast<double>(a.data().size()));
  }

  static double mean(const Image& image) {
    double sum = 0;
    for (float v : image.data()) sum += v;
    return sum / static_cast<double>(image.data().size());
  }

  static void expectWithin(const Image& image, float low, float high) {
    int bad = 0;
    for (float v : image.data()) bad += !(v >= low && v <= high);  // NaN counts
    EXPECT_EQ(bad, 0) << "values outside [" << low << ", " << high << "] or NaN";
  }

 private:
  /// Moves corners of triangles to the first vertex in their cell of a grid, and drops triangles that vanish.
  static void coarsen(scene::Primitive& primitive) {
    constexpr float cells = 20;
    const glm::vec3 sides = primitive.bounds.high - primitive.bounds.low;
    const float cell = std::max({sides.x, sides.y, sides.z}) / cells;
    if (primitive.indices.size() < 3 * 3000 || !(cell > 0)) return;
    std::map<std::array<int, 3>, uint32_t> first;
    const auto moved = [&](uint32_t vertex) {
      const glm::ivec3 at((primitive.positions[vertex] - primitive.bounds.low) / cell);
      return first.try_emplace({at.x, at.y, at.z}, vertex).first->second;
    };
    std::vector<uint32_t> kept;
    for (size_t i = 0; i < primitive.indices.size(); i += 3) {
      const std::array<uint32_t, 3> corners{moved(primitive.indices[i]), moved(primitive.indices[i + 1]),
                                            moved(primitive.indices[i + 2])};
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
        kept.insert(kept.end(), corners.begin(), corners.end());
    }
    primitive.indices = std::move(kept);
  }
};

using RenderTest = OncePerRenderer<PictureTest>;

}  // namespace limn
