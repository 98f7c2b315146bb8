// What to look at: --camera, --light, --environment and their like, and the scene they make.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "apps/limn/light_edits.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/camera.h"
#include "core/scene/default_lights.h"
#include "core/scene/density_grid.h"
#include "core/scene/load.h"

namespace limn::app {
namespace {

constexpr double degrees = 3.14159265358979323846 / 180;

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

/// One number, or three.
glm::vec3 parseCoefficient(const char* option, const std::string& text) {
  const auto number = parseNumber(text);
  const bool alone = number && *number <= 1e30;
  const glm::vec3 v = alone ? glm::vec3(static_cast<float>(*number))
                            : glm::vec3(parseVector(option, text, "one number or red,green,blue per metre"));
  if (v.x < 0 || v.y < 0 || v.z < 0)
    throw UsageError(fmt::format("{} '{}' is not accepted; coefficients must not be negative", option, text));
  return v;
}

std::vector<std::string> cameraNames(const scene::Pose& pose) {
  std::vector<std::string> names;
  for (const auto& camera : pose.cameras) names.push_back(camera.name);
  return names;
}

}  // namespace

void EnvironmentLightOptions::addTo(CLI::App& command, const std::string& prefix) {
  command
      .add_option(
          "--" + prefix + "lights", threshold,
          "Light the scene by area lights that stand for the environment, so that techniques shadow it:\n"
          "how much of a light's energy a row of texels must add for it to grow; smaller: fewer lights")
      ->check(CLI::Range(1e-4, 0.5));
  command
      .add_option("--" + prefix + "resolution", resolution,
                  "Texels along each face of the cube map they are found on")
      ->capture_default_str()
      ->check(CLI::Range(1, shading::largestFaceResolution));
  command.add_option("--" + prefix + "shape", shape, "squares or rectangles")
      ->capture_default_str()
      ->check(CLI::IsMember({"squares", "rectangles"}));
}

shading::DecompositionSettings EnvironmentLightOptions::settings() const {
  return {.threshold = threshold,
          .resolution = resolution,
          .shape = shape == "rectangles" ? shading::RegionShape::rectangles : shading::RegionShape::squares};
}

void SceneOptions::addTo(CLI::App& command) {
  command
      .add_option("scene", scene,
                  "glTF 2.0 scene (.gltf, .glb), or the name of one of limn's own; convert other formats\n"
                  "beforehand, e.g. with assimp")
      ->required();
  command.add_option("--camera", camera, "Camera by name or #index");
  command.add_option("--eye", eye, "Camera position x,y,z in metres (with --target)");
  command.add_option("--target", target, "Point looked at x,y,z in metres");
  command.add_option("--fov", fov, "Vertical field of view, degrees")->check(CLI::Range(0.1, 179.0));
  command.add_option("--environment", environment,
                     "Equirectangular .hdr or .exr, or the name of one of limn's own: sky");
  command.add_option("--environment-rotation", environmentRotation, "About the vertical axis, degrees");
  command.add_option("--environment-scale", environmentScale, "Factor on the environment's radiance")
      ->check(CLI::Range(0.0, 1e9));
  environmentLights.addTo(command, "environment-");
  command
      .add_option("--environment-reflection", environmentReflection,
                  "area: the lights that stand for the environment are reflected as areas; centre: as if "
                  "each came from "
                  "its centre")
      ->capture_default_str()
      ->check(CLI::IsMember({"area", "centre"}));
  command.add_option("--time", time, "Animation time, seconds")->check(CLI::Range(-1e6, 1e6));
  command.add_option("--animation", animation, "Animation by name or #index (default: the first)");
  command.add_option("--size", size, "Picture size WxH, pixels")->capture_default_str();
  command.add_option("--light", light, "Only this light, by name or #index");
  command
      .add_option("--light-size", lightSize,
                  "Side of every area light in metres, angular diameter of directional lights in radians;\n"
                  "intensities stay as they are")
      ->check(CLI::Range(1e-9, 1e9));
  command
      .add_option(
          "--set-light", lightSettings,
          "NAME.PROPERTY=VALUE, repeatable; PROPERTY is position=x,y,z (metres), rotation=pitch,yaw,roll\n"
          "(degrees, of a light that shines along -z), size=u,v (metres; directional: radians),\n"
          "colour=r,g,b or intensity=I (W/sr; directional: W/m^2). Emissive quads are lights, too: they are\n"
          "named as their node, which goes with them")
      ->take_all();
  command.add_option("--sigma-a", sigmaA,
                     "Absorption of the participating medium per metre: one number or red,green,blue");
  command.add_option("--sigma-s", sigmaS, "Scattering of the medium, likewise; 0: it scatters nothing");
  command
      .add_option("--g", g, "Mean cosine of the medium's phase function (Henyey-Greenstein); > 0: forward")
      ->check(CLI::Range(-0.999, 0.999));
  command.add_option(
      "--grid", grid,
      "Where the medium is how dense: an OpenVDB file with a grid 'density' (its factors), smoke\n"
      "(procedural, animated), or none (homogeneous)");
  command
      .add_option("--default-lights", defaultLights,
                  "auto: a scene with neither lights nor --environment gets a key light from above the "
                  "camera's left\n"
                  "shoulder and a headlight in the camera (--light key, --light headlight); on: every scene; "
                  "off: none")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->capture_default_str();
}

scene::CameraPose chooseCamera(const SceneOptions& options, const scene::Pose& pose) {
  scene::CameraPose camera = pose.cameras.empty() ? scene::frameBounds(pose.bounds) : pose.cameras.front();
  if (!options.camera.empty())
    camera = pose.cameras[static_cast<size_t>(findNamed("camera", options.camera, cameraNames(pose)))];
  if (!options.eye.empty() || !options.target.empty()) {
    if (options.eye.empty() || options.target.empty())
      throw UsageError("--eye and --target belong together; one is missing");
    camera = scene::lookAt(glm::vec3(parseVector("--eye", options.eye) - pose.origin),
                           glm::vec3(parseVector("--target", options.target) - pose.origin), camera.yfov);
  }
  if (options.fov > 0) camera.yfov = static_cast<float>(options.fov * degrees);
  return camera;
}

void resizeLights(scene::Scene& scene, double size) {
  const auto side = static_cast<float>(size);
  int resized = 0;
  for (scene::Node& node : scene.nodes) {
    if (node.light == scene::none || node.limnArea == glm::vec2(0)) continue;
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

namespace {

/// Whether the scene is lit by default lights; says so, or that it is dark, unless it is `quiet`.
bool wantsDefaultLights(const SceneOptions& options, const View& view, bool quiet) {
  const bool dark = view.pose.lights.empty() && !view.scene.environment;
  const std::string file = options.scene.string();
  if (options.defaultLights == "off" || view.pose.bounds.empty()) {
    if (dark && !quiet && !view.pose.bounds.empty())
      fmt::print(stderr, "limn: warning: {}: neither lights nor an environment; only emission can be seen\n",
                 file);
    return false;
  }
  if (options.defaultLights == "auto" && !dark) return false;
  if (dark && !quiet)
    fmt::print(
        stderr,
        "limn: warning: {}: neither lights nor an environment; lit by default lights (key, headlight), see "
        "--environment and --default-lights\n",
        file);
  return true;
}

void addEnvironment(const SceneOptions& options, scene::Scene& scene) {
  if (!options.environment.empty())
    scene.environment = scene::loadEnvironment(findEnvironment(options.environment), scene.warnings);
  if (options.environmentLights.threshold > 0) {
    if (!scene.environment)
      throw UsageError("--environment-lights needs --environment: there is no map to find lights in");
    scene.environment.lights =
        shading::decomposeEnvironment(scene.environment, options.environmentLights.settings()).lights;
    scene.environment.reflectCentres = options.environmentReflection == "centre";
  }
}

}  // namespace

void relight(View& view, const SceneOptions& options) {
  scene::Scene& scene = view.scene;
  scene.nodes = view.file.nodes;
  scene.lights = view.file.lights;
  for (size_t i = 0; i < scene.materials.size(); ++i)
    if (scene.materials[i].emission != view.file.emission[i])
      scene.materials[i].emission = view.file.emission[i];
  scene.environment.rotation =
      view.file.environmentRotation + static_cast<float>(options.environmentRotation * degrees);
  scene.environment.scale = view.file.environmentScale * static_cast<float>(options.environmentScale);
  if (options.lightSize > 0) resizeLights(scene, options.lightSize);
  scene::evaluate(scene, view.time, view.animation, view.pose);
  view.camera = chooseCamera(options, view.pose);
  if (view.defaultLights) {
    scene::addDefaultLights(scene, view.camera, view.pose.bounds);
    scene::evaluate(scene, view.time, view.animation, view.pose);
  }
  if (options.lightSettings.empty()) return;
  applyLightEdits(scene, view.pose, parseLightEdits(options.lightSettings));
  scene::evaluate(scene, view.time, view.animation, view.pose);
}

void moveTo(View& view, const SceneOptions& options, double time) {
  view.time = time;
  if (view.defaultLights) {
    relight(view, options);
    return;
  }
  scene::evaluate(view.scene, view.time, view.animation, view.pose);
  view.camera = chooseCamera(options, view.pose);
}

/// --grid.
static void chooseGrid(const std::string& grid, scene::Scene& scene) {
  if (!scene.medium.present())
    throw UsageError(
        fmt::format("--grid {}: the scene has no medium; give it --sigma-s or --sigma-a, too", grid));
  scene.medium.grid.reset();
  scene.medium.smoke.reset();
  if (grid == "none") return;
  if (grid == "smoke")
    scene.medium.smoke = scene::smokeIn(scene::evaluate(scene, 0).bounds);
  else
    scene::setGrid(scene.medium, scene::readDensityGrid(grid, {}, scene.origin));
}

View open(const SceneOptions& options, bool quiet) {
  View view;
  view.size = parseSize(options.size);
  view.scene = scene::load(findScene(options.scene));
  addEnvironment(options, view.scene);
  giveOwnMaterials(view.scene);
  view.file = {
      view.scene.nodes, view.scene.lights, {}, view.scene.environment.rotation, view.scene.environment.scale};
  for (const scene::Material& material : view.scene.materials)
    view.file.emission.push_back(material.emission);
  if (!options.sigmaA.empty()) view.scene.medium.sigmaA = parseCoefficient("--sigma-a", options.sigmaA);
  if (!options.sigmaS.empty()) view.scene.medium.sigmaS = parseCoefficient("--sigma-s", options.sigmaS);
  if (options.g) view.scene.medium.g = static_cast<float>(*options.g);
  if (!options.grid.empty()) chooseGrid(options.grid, view.scene);
  if (!quiet)
    for (const std::string& warning : view.scene.warnings) warn(warning);
  if (!options.animation.empty()) {
    std::vector<std::string> names;
    for (const auto& animation : view.scene.animations) names.push_back(animation.name);
    view.animation = findNamed("animation", options.animation, names);
  }
  view.time = options.time;
  view.pose = scene::evaluate(view.scene, view.time, view.animation);
  view.defaultLights = wantsDefaultLights(options, view, quiet);
  relight(view, options);
  if (!options.light.empty()) view.light = findNamed("light", options.light, view.pose.lightNames);
  return view;
}

reference::Request referenceRequest(const View& view, const scene::Pose& pose,
                                    const scene::CameraPose& camera, reference::Term term) {
  reference::Request request{
      .scene = view.scene, .pose = pose, .camera = camera, .progress = {}, .checkpoint = {}};
  request.width = view.size.x;
  request.height = view.size.y;
  request.term = term;
  request.light = view.light == scene::none ? reference::allLights : view.light;
  request.bounces = term == reference::Term::indirect ? 1 : 0;
  request.interfaces = term == reference::Term::specular ? reference::imageSpaceInterfaces : 0;
  return request;
}

}  // namespace limn::app
