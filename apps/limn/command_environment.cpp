// limn environment: what the lights of a decomposed environment are, as a list and as a picture.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "apps/limn/provenance.h"
#include "apps/limn/tone_flags.h"
#include "core/base/error.h"
#include "core/question/question_fields.h"
#include "core/scene_io/load.h"
#include "core/session/find.h"
#include "core/session/view.h"
#include "core/shading/environment_decomposition.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct EnvironmentArguments {
  fs::path map;
  SceneQuestion lights{.environmentLights = 0.015};
  fs::path overlay;
  int width = 1024;
  double exposure = 0;
  bool json = false;
};

constexpr double kDegrees = 180 / 3.14159265358979323846;

/// One light as people read it.
struct LightRow {
  double azimuth, elevation;  ///< of its centre, degrees; azimuth from -z towards +x
  glm::vec2 size;             ///< angles across its centre, degrees
  glm::vec3 irradiance;
  double share;  ///< of the luminance of all
};

std::vector<LightRow> rowsOf(const shading::EnvironmentDecomposition& decomposition) {
  double total = 0;
  for (const auto& light : decomposition.lights)
    total += static_cast<double>(glsl::luminance(light.irradiance));
  std::vector<LightRow> rows;
  for (const scene::DistantRectangle& light : decomposition.lights) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(light.centre));
    const auto across = [&](const glm::vec3& axis, float side) {
      const glm::vec3 half = 0.5f * side * axis;
      return std::acos(std::min(
                 1.f, glm::dot(glm::normalize(light.centre - half), glm::normalize(light.centre + half)))) *
             static_cast<float>(kDegrees);
    };
    rows.push_back({std::atan2(d.x, -d.z) * kDegrees,
                    std::asin(d.y) * kDegrees,
                    {across(light.axisU, light.sides.x), across(light.axisV, light.sides.y)},
                    light.irradiance,
                    total > 0 ? static_cast<double>(glsl::luminance(light.irradiance)) / total : 0});
  }
  return rows;
}

void printLights(const std::vector<LightRow>& rows) {
  fmt::print("{:<9} {:>8} {:>9} {:>13} {:>32} {:>8}\n", "light", "azimuth", "elevation", "size",
             "irradiance RGB, W/m^2", "share");
  for (size_t i = 0; i < rows.size(); ++i) {
    const LightRow& r = rows[i];
    fmt::print("{:<9} {:>7.1f}° {:>8.1f}° {:>6.1f}x{:<5.1f}° {:>10.4g} {:>10.4g} {:>10.4g} {:>7.2f}%\n",
               fmt::format("env#{}", i), r.azimuth, r.elevation, r.size.x, r.size.y, r.irradiance.x,
               r.irradiance.y, r.irradiance.z, 100 * r.share);
  }
}

nlohmann::ordered_json toJson(const std::vector<LightRow>& rows, const EnvironmentArguments& options,
                              double milliseconds) {
  nlohmann::ordered_json json = {{"map", options.map.string()},
                                 {"threshold", options.lights.environmentLights},
                                 {"resolution", options.lights.environmentResolution},
                                 {"shape", options.lights.environmentShape},
                                 {"milliseconds", milliseconds},
                                 {"lights", nlohmann::ordered_json::array()}};
  for (size_t i = 0; i < rows.size(); ++i) {
    const LightRow& r = rows[i];
    json["lights"].push_back({{"name", fmt::format("env#{}", i)},
                              {"azimuth", r.azimuth},
                              {"elevation", r.elevation},
                              {"size", {r.size.x, r.size.y}},
                              {"irradiance", {r.irradiance.x, r.irradiance.y, r.irradiance.z}},
                              {"share", r.share}});
  }
  return json;
}

int runEnvironment(const EnvironmentArguments& options) {
  if (!options.overlay.empty()) {
    checkExtension("--overlay", options.overlay, {".png", ".exr"});
    checkWritable(options.overlay);
    checkApart({options.overlay}, {options.map});
  }
  std::vector<std::string> warnings;
  const scene::Environment map = scene::loadEnvironment(session::findEnvironment(options.map), warnings);
  for (const std::string& warning : warnings) warn(warning);
  const auto start = std::chrono::steady_clock::now();
  const shading::EnvironmentDecomposition lights =
      shading::decomposeEnvironment(map, session::decompositionSettings(options.lights));
  const double milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const std::vector<LightRow> rows = rowsOf(lights);
  if (options.json) {
    printAsJson(toJson(rows, options, milliseconds));
  } else {
    printLights(rows);
    fmt::print("{}: {} lights in {:.1f} ms\n", options.map.string(), rows.size(), milliseconds);
  }
  if (!options.overlay.empty()) {
    Image overlay =
        shading::decompositionOverlay(map, lights, options.width, static_cast<float>(options.exposure));
    sign(overlay);
    writeImage(options.overlay, overlay);
    sayWritten(options.overlay);
  }
  return 0;
}

}  // namespace

Action addEnvironmentCommand(CLI::App& command) {
  auto options = std::make_shared<EnvironmentArguments>();
  command.add_option("map", options->map, questionField("environment").doc)->required();
  addSceneFlag(command, options->lights, "environment_lights", "--lights");
  addSceneFlag(command, options->lights, "environment_resolution", "--resolution");
  addSceneFlag(command, options->lights, "environment_shape", "--shape");
  CLI::Option* overlay = command.add_option("--overlay", options->overlay,
                                            "Write the map with the lights' outlines: .png or .exr");
  command.add_option("--width", options->width, "Width of the overlay, pixels")
      ->capture_default_str()
      ->transform(wholeRange(16, 16384))
      ->needs(overlay);
  command.add_option("--exposure", options->exposure, "Exposure of the overlay, EV")
      ->check(exposureRange())
      ->needs(overlay);
  command.add_flag("--json", options->json, "Print JSON instead of a table");
  return [options] { return runEnvironment(*options); };
}

}  // namespace limn::app
