#include "apps/limn/options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/camera.h"
#include "core/scene/default_lights.h"
#include "core/scene/load.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

constexpr double degrees = 3.14159265358979323846 / 180;

glm::vec3 parseVector(const char* option, const std::string& text,
                      const char* expected = "three numbers x,y,z in metres") {
  glm::vec3 v;
  std::string_view rest = text;
  for (int i = 0; i < 3; ++i) {
    const size_t comma = i < 2 ? rest.find(',') : rest.size();
    const auto number = comma == std::string_view::npos ? std::nullopt : parseNumber(rest.substr(0, comma));
    if (!number || std::abs(*number) > 1e30)
      throw UsageError(fmt::format("{} '{}' is not accepted; expected {}", option, text, expected));
    v[i] = static_cast<float>(*number);
    rest = i < 2 ? rest.substr(comma + 1) : rest;
  }
  return v;
}

/// One number, or three.
glm::vec3 parseCoefficient(const char* option, const std::string& text) {
  const auto number = parseNumber(text);
  const bool alone = number && *number <= 1e30;
  const glm::vec3 v = alone ? glm::vec3(static_cast<float>(*number))
                            : parseVector(option, text, "one number or red,green,blue per metre");
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
  command.add_option("--sigma-a", sigmaA,
                     "Absorption of the participating medium per metre: one number or red,green,blue");
  command.add_option("--sigma-s", sigmaS, "Scattering of the medium, likewise; 0: it scatters nothing");
  command
      .add_option("--g", g, "Mean cosine of the medium's phase function (Henyey-Greenstein); > 0: forward")
      ->check(CLI::Range(-0.999, 0.999));
  command
      .add_option("--default-lights", defaultLights,
                  "auto: a scene with neither lights nor --environment gets a key light from above the "
                  "camera's left\n"
                  "shoulder and a headlight in the camera (--light key, --light headlight); on: every scene; "
                  "off: none")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->capture_default_str();
}

fs::path findShared(const fs::path& folder, const fs::path& file) {
  std::error_code ignored;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path();
  for (const fs::path& share : {prefix, prefix / "share/limn"})
    if (fs::exists(share / folder / file, ignored)) return share / folder / file;
  return {};
}

fs::path findScene(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const std::string name = nameOrFile.string();
  if (name.find('/') == std::string::npos)
    if (const fs::path file = findShared("assets", fs::path(name) / (name + ".glb")); !file.empty())
      return file;
  throw Error(fmt::format(
      "scene '{}' does not exist; expected a .gltf or .glb file, or the name of one of limn's scenes", name));
}

fs::path findEnvironment(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const fs::path name = nameOrFile.filename();
  if (name == nameOrFile)
    if (const fs::path file = findShared("assets/environments", name.string() + ".exr"); !file.empty())
      return file;
  throw Error(fmt::format(
      "environment '{}' does not exist; expected an equirectangular .exr or .hdr file, or the name of one of "
      "limn's maps",
      nameOrFile.string()));
}

void createFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(fmt::format("folder '{}' cannot be created: {}", folder.string(), error.message()));
}

void checkWritable(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored))
    throw Error(fmt::format("{}: cannot be written: it is a folder", file.string()));
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

glm::ivec2 parseSize(const std::string& text) {
  const size_t x = text.find('x');
  const auto width = x == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(0, x));
  const auto height =
      x == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(x + 1));
  const auto fits = [](const std::optional<double>& v) {
    return v && *v >= 1 && *v <= 16384 && *v == std::floor(*v);
  };
  if (!fits(width) || !fits(height))
    throw UsageError(
        fmt::format("--size '{}' is not accepted; expected WxH, each from 1 to 16384 pixels", text));
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

std::optional<FrameRange> parseFrames(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const size_t colon = text.find(':');
  const auto first =
      colon == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(0, colon));
  const auto last =
      colon == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(colon + 1));
  const auto whole = [](double v) { return v == std::floor(v) && v >= 0 && v <= 1e6; };
  if (!first || !last || !whole(*first) || !whole(*last) || *first > *last)
    throw UsageError(
        fmt::format("--frames '{}' is not accepted; expected a:b with 0 <= a <= b <= 1000000", text));
  return FrameRange{static_cast<int>(*first), static_cast<int>(*last)};
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

scene::CameraPose chooseCamera(const SceneOptions& options, const scene::Pose& pose) {
  scene::CameraPose camera = pose.cameras.empty() ? scene::frameBounds(pose.bounds) : pose.cameras.front();
  if (!options.camera.empty())
    camera = pose.cameras[static_cast<size_t>(findNamed("camera", options.camera, cameraNames(pose)))];
  if (!options.eye.empty() || !options.target.empty()) {
    if (options.eye.empty() || options.target.empty())
      throw UsageError("--eye and --target belong together; one is missing");
    camera = scene::lookAt(parseVector("--eye", options.eye), parseVector("--target", options.target),
                           camera.yfov);
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

/// Adds the default lights where they are wanted; says so.
static void lightUp(const SceneOptions& options, View& view) {
  const bool dark = view.pose.lights.empty() && !view.scene.environment;
  const std::string file = options.scene.string();
  if (options.defaultLights == "off" || view.pose.bounds.empty()) {
    if (dark && !view.pose.bounds.empty())
      fmt::print(stderr, "limn: warning: {}: neither lights nor an environment; only emission can be seen\n",
                 file);
    return;
  }
  if (options.defaultLights == "auto" && !dark) return;
  if (dark)
    fmt::print(
        stderr,
        "limn: warning: {}: neither lights nor an environment; lit by default lights (key, headlight), see "
        "--environment and --default-lights\n",
        file);
  scene::addDefaultLights(view.scene, view.camera, view.pose.bounds);
  scene::evaluate(view.scene, view.time, view.animation, view.pose);
}

View open(const SceneOptions& options) {
  View view;
  view.size = parseSize(options.size);
  view.scene = scene::load(findScene(options.scene));
  if (!options.environment.empty())
    view.scene.environment = scene::loadEnvironment(findEnvironment(options.environment));
  view.scene.environment.rotation += static_cast<float>(options.environmentRotation * degrees);
  view.scene.environment.scale *= static_cast<float>(options.environmentScale);
  if (options.environmentLights.threshold > 0) {
    if (!view.scene.environment)
      throw UsageError("--environment-lights needs --environment: there is no map to find lights in");
    view.scene.environment.lights =
        shading::decomposeEnvironment(view.scene.environment, options.environmentLights.settings()).lights;
    view.scene.environment.reflectCentres = options.environmentReflection == "centre";
  }
  if (!options.sigmaA.empty()) view.scene.medium.sigmaA = parseCoefficient("--sigma-a", options.sigmaA);
  if (!options.sigmaS.empty()) view.scene.medium.sigmaS = parseCoefficient("--sigma-s", options.sigmaS);
  if (options.g) view.scene.medium.g = static_cast<float>(*options.g);
  for (const std::string& warning : view.scene.warnings) fmt::print(stderr, "limn: warning: {}\n", warning);
  if (!options.animation.empty()) {
    std::vector<std::string> names;
    for (const auto& animation : view.scene.animations) names.push_back(animation.name);
    view.animation = findNamed("animation", options.animation, names);
  }
  view.time = options.time;
  if (options.lightSize > 0) resizeLights(view.scene, options.lightSize);
  view.pose = scene::evaluate(view.scene, view.time, view.animation);
  view.camera = chooseCamera(options, view.pose);
  lightUp(options, view);
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
  return request;
}

void TechniqueOptions::addTo(CLI::App& command) {
  command.add_option("--technique", techniques,
                     "Techniques, comma-separated (see limn list); none: unshadowed");
  command.add_option("--set", settings, "TECHNIQUE.PARAMETER=VALUE, repeatable")->take_all();
}

std::vector<render::TechniqueUse> TechniqueOptions::resolve(const TechniqueRegistry& registry) const {
  std::vector<render::TechniqueUse> uses;
  std::string_view rest = techniques;
  while (!rest.empty()) {
    const size_t comma = rest.find(',');
    const std::string_view name = rest.substr(0, comma);
    const TechniquePlugin& plugin = registry.find(name);
    for (const auto& use : uses)
      if (use.plugin == &plugin)
        throw UsageError(fmt::format("technique {} is named twice; once is enough", name));
    uses.push_back({&plugin, ParameterValues(std::string(name), plugin.info->parameters)});
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  for (const std::string& setting : settings) {
    const size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || equals < dot)
      throw UsageError(
          fmt::format("--set '{}' is not accepted; expected TECHNIQUE.PARAMETER=VALUE", setting));
    const std::string technique = setting.substr(0, dot);
    bool found = false;
    for (auto& use : uses) {
      if (technique != use.plugin->info->name) continue;
      use.parameters.set(setting.substr(dot + 1, equals - dot - 1), setting.substr(equals + 1));
      found = true;
    }
    if (!found)
      throw UsageError(
          fmt::format("--set '{}' names technique {}, which --technique does not", setting, technique));
  }
  return uses;
}

void BackendOptions::addTo(CLI::App& command) {
  command.add_option("--backend", backend, "egl or osmesa")->capture_default_str();
  command.add_option("--device", device, "EGL device index, see limn info")->check(CLI::Range(0, 255));
  command.add_flag("--gl-debug", debug, "Debug context: driver errors end the run");
}

ContextOptions BackendOptions::contextOptions() const {
  ContextOptions options;
  options.backend = parseBackend(backend);
  options.device = device;
  options.debug = debug;
  options.visible = false;
  return options;
}

int guarded(const std::function<int()>& work) {
  const auto say = [](const std::string& message) {
    std::fputs(("limn: " + message + "\n").c_str(), stderr);
  };
  try {
    return work();
  } catch (const UsageError& error) {
    say(error.what());
    return 2;
  } catch (const std::bad_alloc&) {
    say("out of memory");
  } catch (const fs::filesystem_error& error) {
    say(error.what());
  } catch (const std::system_error& error) {  // of fmt::print: the buffer was full before the end
    say("standard output cannot be written: " + error.code().message());
  } catch (const std::exception& error) {
    say(error.what());
  }
  return 1;
}

Progress::Progress(std::string label) : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (terminal_ && lastShown_ >= 0) std::fputs("\r\033[K", stderr);
}

void Progress::update(double fraction, const std::string& note) {
  const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
  if (terminal_) {
    constexpr int width = 30;
    const std::string bar(static_cast<size_t>(percent * width / 100), '#');
    std::fputs(fmt::format("\r{} [{:<{}}] {:3}% {}\033[K", label_, bar, width, percent, note).c_str(),
               stderr);
  } else if (percent / 10 > lastShown_ / 10 || lastShown_ < 0) {
    std::fputs(fmt::format("{}: {}% {}\n", label_, percent, note).c_str(), stderr);
  } else {
    return;
  }
  lastShown_ = percent;
}

}  // namespace limn::app
