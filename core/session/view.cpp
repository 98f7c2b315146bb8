#include "core/session/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/question/question_fields.h"
#include "core/scene/camera.h"
#include "core/scene/default_lights.h"
#include "core/scene/displaced.h"
#include "core/scene/floor.h"
#include "core/scene/framing.h"
#include "core/scene_io/density_grid_file.h"
#include "core/scene_io/load.h"
#include "core/session/find.h"
#include "core/session/light_edits.h"
#include "core/session/private/mesh_light.h"

namespace limn::session {
namespace {

static_assert(shading::DecompositionSettings{}.resolution == 48 && shading::kLargestFaceResolution == 512,
              "what the table of questions says of environment_resolution");

constexpr double kDegrees = 3.14159265358979323846 / 180;

glm::dvec3 parseVector(const char* option, const std::string& text,
                       const char* expected = "three numbers x,y,z in metres") {
  glm::dvec3 v;
  std::string_view rest = text;
  for (int i = 0; i < 3; ++i) {
    const size_t comma = i < 2 ? rest.find(',') : rest.size();
    const auto number = comma == std::string_view::npos ? std::nullopt : parseNumber(rest.substr(0, comma));
    if (!number || std::abs(*number) > 1e30)
      throw UsageError(fmt::format("{} '{}' is not accepted; expected {}", option, text, expected));
    v[i] = *number;
    rest = i < 2 ? rest.substr(comma + 1) : rest;
  }
  return v;
}

/// One number, or three, per metre or, followed by /scene, per `diameter` of the scene in metres (0: nothing
/// to fill).
glm::vec3 parseCoefficient(const char* option, const std::string& text, double diameter) {
  constexpr std::string_view kPerScene = "/scene";
  const bool perScene = text.ends_with(kPerScene);
  const std::string numbers = perScene ? text.substr(0, text.size() - kPerScene.size()) : text;
  const auto number = parseNumber(numbers);
  const bool alone = number && *number <= 1e30;
  glm::dvec3 v = alone ? glm::dvec3(*number)
                       : parseVector(option, numbers,
                                     "one number or red,green,blue per metre, or these with /scene behind "
                                     "them, per diameter of the scene");
  if (v.x < 0 || v.y < 0 || v.z < 0)
    throw UsageError(fmt::format("{} '{}' is not accepted; coefficients must not be negative", option, text));
  if (perScene) v = diameter > 0 ? v / diameter : glm::dvec3(0);
  if (std::max({v.x, v.y, v.z}) > 1e30)
    throw UsageError(
        fmt::format("{} '{}' is not accepted; the scene is {:.3g} m wide", option, text, diameter));
  return glm::vec3(v);
}

}  // namespace

std::vector<std::string> cameraNames(const scene::Pose& pose) {
  std::vector<std::string> names;
  for (const auto& camera : pose.cameras) names.push_back(camera.name);
  return names;
}

int findNamed(const std::string& what, const std::string& text, const std::vector<std::string>& names) {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == text) return static_cast<int>(i);
  if (text.starts_with('#'))
    if (const auto index = parseNumber(std::string_view(text).substr(1));
        index && *index >= 0 && *index < static_cast<double>(names.size()) && *index == std::floor(*index))
      return static_cast<int>(*index);
  constexpr size_t listed = 20;
  std::vector<std::string> shown(names.begin(),
                                 names.begin() + static_cast<long>(std::min(names.size(), listed)));
  throw UsageError(
      fmt::format("{} '{}' is not in the scene{}; it has {}{}", what, text, didYouMean(text, names),
                  names.empty() ? "none" : joined(shown),
                  names.size() > listed ? fmt::format(" and {} more", names.size() - listed) : ""));
}

std::vector<std::string> findableNames(std::vector<std::string> names) {
  std::unordered_set<std::string> known;
  for (size_t i = 0; i < names.size(); ++i)
    if (!known.insert(names[i]).second) names[i] = fmt::format("#{}", i);
  return names;
}

scene::CameraPose chooseCamera(const SceneQuestion& question, const scene::Pose& pose,
                               const scene::CameraPose& framing) {
  scene::CameraPose camera = pose.cameras.empty() ? framing : pose.cameras.front();
  if (!question.camera.empty())
    camera = pose.cameras[static_cast<size_t>(findNamed("camera", question.camera, cameraNames(pose)))];
  if (!question.eye.empty() || !question.target.empty()) {
    if (question.eye.empty() || question.target.empty())
      throw UsageError("--eye and --target belong together; one is missing");
    camera = scene::lookAt(glm::vec3(parseVector("--eye", question.eye) - pose.origin),
                           glm::vec3(parseVector("--target", question.target) - pose.origin), camera.yfov);
  }
  if (question.fov > 0) camera.yfov = static_cast<float>(question.fov * kDegrees);
  return camera;
}

void resizeLights(scene::Scene& scene, double size) {
  const auto side = static_cast<float>(size);
  int resized = 0;
  for (scene::Node& node : scene.nodes) {
    if (node.light == scene::kNone || node.limnArea == glm::vec2(0)) continue;
    node.limnArea = glm::vec2(side);
    ++resized;
  }
  for (scene::LightSource& light : scene.lights) {
    if (light.type != glsl::light_directional) continue;
    light.angle = side;
    ++resized;
  }
  if (resized == 0)
    throw UsageError(fmt::format(
        "--light-size {}: the scene has neither lights with limn_area nor directional lights", size));
}

shading::DecompositionSettings decompositionSettings(const SceneQuestion& question) {
  return {
      .threshold = question.environmentLights,
      .resolution = question.environmentResolution,
      .shape = question.environmentShape == "rectangles" ? RegionShape::rectangles : RegionShape::squares};
}

namespace {

/// Returns whether the scene is lit by default lights; `warn` is told that it is, or that it is dark.
bool wantsDefaultLights(const SceneQuestion& question, const View& view, const Warn& warn) {
  const bool dark = view.pose.lights.empty() && !view.scene.environment;
  const std::string file = question.scene;
  if (question.defaultLights == "off" || view.pose.bounds.empty()) {
    if (dark && warn && !view.pose.bounds.empty())
      warn(fmt::format("{}: neither lights nor an environment; only emission can be seen", file));
    return false;
  }
  if (question.defaultLights == "auto" && !dark) return false;
  if (dark && warn)
    warn(
        fmt::format("{}: neither lights nor an environment; lit by default lights (key, headlight) in the "
                    "environment studio, see --environment and --default-lights",
                    file));
  return true;
}

/// Warns of a medium that hides the scene: coefficients are per metre, and scenes may be large.
void warnOfOpaqueMedium(const View& view, const Warn& warn) {
  constexpr double kDepth = 20;  // over the diameter: what is seen in the middle has e^-20 of its light left
  const scene::Medium& medium = view.scene.medium;
  if (!warn || !medium.present() || medium.inhomogeneous()) return;
  const glm::vec3 extinction = medium.sigmaA + medium.sigmaS;
  const double least = std::min({extinction.x, extinction.y, extinction.z});
  const double diameter = 2.0 * view.pose.bounds.radius();
  if (least * diameter > kDepth)
    warn(
        fmt::format("the medium's optical depth is {:.3g} over the {:.3g} m of the scene, so that little "
                    "or nothing is seen; --sigma-a and --sigma-s are per metre, {:.3g} of both together or "
                    "1/scene is a depth of 1",
                    least * diameter, diameter, 1 / diameter));
}

void addEnvironment(const SceneQuestion& question, scene::Scene& scene) {
  if (!question.environment.empty())
    scene.environment = scene::loadEnvironment(findEnvironment(question.environment), scene.warnings);
  if (question.environmentLights > 0) {
    if (!scene.environment)
      throw UsageError("--environment-lights needs --environment: there is no map to find lights in");
    scene.environment.lights =
        shading::decomposeEnvironment(scene.environment, decompositionSettings(question)).lights;
    scene.environment.reflectCentres = question.environmentReflection == "centre";
    scene.environment.shadowedByRatio = question.environmentCombine == "ratio";
  }
}

}  // namespace

void relight(View& view, const SceneQuestion& question) {
  scene::Scene& scene = view.scene;
  scene.nodes = view.file.nodes;
  scene.lights = view.file.lights;
  for (size_t i = 0; i < scene.materials.size(); ++i)
    if (scene.materials[i].emission != view.file.emission[i])
      scene.materials[i].emission = view.file.emission[i];
  const float rotation =
                  view.file.environmentRotation + static_cast<float>(question.environmentRotation * kDegrees),
              scale = view.file.environmentScale * static_cast<float>(question.environmentScale);
  // Where nothing changes, a reference may go on reading it.
  if (scene.environment.rotation != rotation) scene.environment.rotation = rotation;
  if (scene.environment.scale != scale) scene.environment.scale = scale;
  const auto resize = [&] {
    if (question.lightSize > 0) resizeLights(scene, question.lightSize);
  };
  if (!view.defaultLights) resize();
  scene::evaluate(scene, view.time, view.animation, view.pose);
  view.camera = chooseCamera(question, view.pose, view.framing);
  if (view.defaultLights) {
    scene::addDefaultLights(scene, view.camera, view.pose.bounds);
    resize();  // the key light as well
    scene::evaluate(scene, view.time, view.animation, view.pose);
  }
  if (question.lightSettings.empty()) return;
  applyLightEdits(scene, view.pose, parseLightEdits(question.lightSettings), view.animation);
  scene::evaluate(scene, view.time, view.animation, view.pose);
}

bool movingRelights(const View& view, const SceneQuestion& question, double time) {
  if (view.defaultLights) return true;
  if (time == view.time || view.scene.animations.empty() || question.lightSettings.empty()) return false;
  return view.file.appearsLater || followTime(parseLightEdits(question.lightSettings));
}

void moveTo(View& view, const SceneQuestion& question, double time) {
  const bool relights = movingRelights(view, question, time);
  view.time = time;
  if (relights) {
    relight(view, question);
    return;
  }
  scene::evaluate(view.scene, view.time, view.animation, view.pose);
  view.camera = chooseCamera(question, view.pose, view.framing);
}

/// --sigma-a, --sigma-s and --g.
static void fillMedium(const SceneQuestion& question, View& view) {
  scene::Medium& medium = view.scene.medium;
  if (!question.sigmaA.empty() || !question.sigmaS.empty()) {
    const scene::Bounds bounds = scene::evaluate(view.scene, 0, view.animation).bounds;
    const double diameter = bounds.empty() ? 0 : 2.0 * bounds.radius();
    if (!question.sigmaA.empty()) medium.sigmaA = parseCoefficient("--sigma-a", question.sigmaA, diameter);
    if (!question.sigmaS.empty()) medium.sigmaS = parseCoefficient("--sigma-s", question.sigmaS, diameter);
  }
  if (question.g) medium.g = static_cast<float>(*question.g);
}

/// --grid.
static void chooseGrid(const std::string& grid, View& view) {
  scene::Medium& medium = view.scene.medium;
  if (!medium.present())
    throw UsageError(
        fmt::format("--grid {}: the scene has no medium; give it --sigma-s or --sigma-a, too", grid));
  medium.grid.reset();
  medium.smoke.reset();
  if (grid == "none") return;
  if (grid == "smoke")
    medium.smoke = scene::smokeIn(scene::evaluate(view.scene, 0, view.animation).bounds);
  else
    scene::setGrid(medium, scene::readDensityGrid(grid, {}, view.scene.origin));
}

/// The camera of a scene without one, which looks at what stands on the floor, and --floor.
static void frame(const SceneQuestion& question, View& view) {
  const scene::Pose start = scene::evaluate(view.scene, 0, view.animation);
  if (start.cameras.empty()) view.framing = scene::frameScene(view.scene, view.animation);
  if (question.floor == "on") scene::addFloor(view.scene, scene::vertexBounds(view.scene, start));
}

/// What needs nothing of the scene.
static void setPicture(const SceneQuestion& question, View& view) {
  view.size = {question.width, question.height};
  view.aa = question.aa;
  view.unshadowed = question.unshadowed == "on";
  view.reliefPaths = reliefPathsOf(question.reliefPaths);
  view.subsurface = subsurfaceModelOf(question.subsurface);
}

void chooseLight(View& view, const SceneQuestion& question) {
  view.light =
      question.light.empty() ? scene::kNone : findNamed("light", question.light, view.pose.lightNames);
}

View open(const SceneQuestion& question, const Warn& warn) {
  View view;
  setPicture(question, view);
  view.scene = scene::load(findScene(question.scene));
  if (question.displaced == "on") view.scene = scene::displaced(std::move(view.scene));
  addEnvironment(question, view.scene);
  if (!question.animation.empty()) {
    std::vector<std::string> names;
    for (const auto& animation : view.scene.animations) names.push_back(animation.name);
    view.animation = findNamed("animation", question.animation, names);
  }
  fillMedium(question, view);
  if (!question.grid.empty()) chooseGrid(question.grid, view);
  frame(question, view);
  giveOwnMaterials(view.scene);
  view.file = {view.scene.nodes,
               view.scene.lights,
               {},
               view.scene.environment.rotation,
               view.scene.environment.scale,
               appearsLater(view.scene, view.animation)};
  for (const scene::Material& material : view.scene.materials)
    view.file.emission.push_back(material.emission);
  if (warn)
    for (const std::string& warning : view.scene.warnings) warn(warning);
  view.time = question.time;
  view.pose = scene::evaluate(view.scene, view.time, view.animation);
  view.defaultLights = wantsDefaultLights(question, view, warn);
  if (view.defaultLights && !view.scene.environment)
    view.scene.environment = scene::loadEnvironment(findDefaultEnvironment(), view.scene.warnings);
  relight(view, question);
  warnOfOpaqueMedium(view, warn);
  chooseLight(view, question);
  return view;
}

/// Adds what is read with default lights; where it is not installed, a scene that wants them says so when it
/// is opened.
static void addDefaultEnvironment(std::vector<std::filesystem::path>& files) {
  try {
    files.push_back(findDefaultEnvironment());
  } catch (const Error&) {
  }
}

std::vector<std::filesystem::path> inputFiles(const SceneQuestion& question) {
  std::vector<std::filesystem::path> files = scene::filesOf(findScene(question.scene));
  if (!question.environment.empty())
    files.push_back(findEnvironment(question.environment));
  else if (question.defaultLights != "off")  // whether they are wanted is known once the scene is loaded
    addDefaultEnvironment(files);
  const std::string& grid = question.grid;
  if (!grid.empty() && grid != "smoke" && grid != "none") files.emplace_back(grid);
  return files;
}

SceneQuestion openedScene(const SceneQuestion& question) {
  const SceneQuestion standard;
  SceneQuestion scene = question;
  copyFields(QuestionEffect::view, scene, standard);
  scene.lightSize = standard.lightSize;
  return scene;
}

bool show(View& view, const SceneQuestion& shown, const SceneQuestion& asked) {
  setPicture(asked, view);
  const bool relit = view.defaultLights || asked.lightSize != shown.lightSize;
  if (relit)
    relight(view, asked);
  else
    view.camera = chooseCamera(asked, view.pose, view.framing);
  chooseLight(view, asked);
  return relit;
}

reference::Request referenceRequest(const View& view, const scene::Pose& pose,
                                    const scene::CameraPose& camera, Term term) {
  reference::Request request{
      .scene = view.scene, .pose = pose, .camera = camera, .progress = {}, .checkpoint = {}};
  request.width = view.size.x;
  request.height = view.size.y;
  request.aa = view.aa;
  request.term = term;
  request.unshadowed = view.unshadowed;
  request.reliefPaths = view.reliefPaths;
  request.subsurface = view.subsurface;
  request.light = view.light == scene::kNone ? reference::kAllLights : view.light;
  request.bounces = reference::defaultBounces(term);
  request.interfaces = reference::defaultInterfaces(term);
  return request;
}

}  // namespace limn::session
