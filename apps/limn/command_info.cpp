// limn info: what this machine offers, and which technique modules limn uses; or what a scene holds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/version.h"
#include "core/gpu/device.h"
#include "core/scene_io/load.h"
#include "core/session/find.h"
#include "core/technique/registry.h"

namespace limn::app {
namespace {

nlohmann::ordered_json describe(const DeviceDescription& device) {
  nlohmann::ordered_json json{
      {"backend", name(device.backend)}, {"device", device.device}, {"description", device.description}};
  if (!device.problem.empty()) {
    json["problem"] = device.problem;
    return json;
  }
  ContextOptions options;
  options.backend = device.backend;
  options.device = device.device;
  options.visible = false;
  try {
    const auto context = Context::create(options);
    const gpu::Device gpuDevice(*context);
    const ContextInfo& info = context->info();
    const gpu::Limits& limits = gpuDevice.limits();
    json["renderer"] = info.renderer;
    json["vendor"] = info.vendor;
    json["version"] = info.version;
    json["software"] = info.software;
    json["limits"] = {{"texture_size", limits.maxTextureSize},
                      {"array_layers", limits.maxArrayLayers},
                      {"storage_block_bytes", limits.maxStorageBlockBytes},
                      {"uniform_block_bytes", limits.maxUniformBlockBytes},
                      {"shared_memory_bytes", limits.maxSharedMemoryBytes},
                      {"layer_from_vertex_shader", limits.layerFromVertexShader}};
  } catch (const Error& error) {
    json["problem"] = error.what();
  }
  return json;
}

void printDevice(const nlohmann::ordered_json& device) {
  const int index = device["device"];
  fmt::print("{}{}: {}\n", device["backend"].get<std::string>(),
             index < 0 ? "" : fmt::format(" --device {}", index), device["description"].get<std::string>());
  if (device.contains("problem")) {
    fmt::print("  not usable: {}\n", device["problem"].get<std::string>());
    return;
  }
  fmt::print("  {} | OpenGL {}{}\n", device["renderer"].get<std::string>(),
             device["version"].get<std::string>(),
             device["software"].get<bool>() ? " | software: passes are timed with glFinish and a clock" : "");
  for (const auto& [key, value] : device["limits"].items()) fmt::print("  {}: {}\n", key, value.dump());
}

/// Every module in the order of names; `refused` says why limn does not use it.
nlohmann::ordered_json modules(const TechniqueRegistry& registry) {
  std::map<std::string, nlohmann::ordered_json> byName;
  const auto add = [&](const std::string& name, nlohmann::ordered_json refused) {
    const std::filesystem::path file = registry.fileOf(name);
    byName[name] = {{"name", name},
                    {"file", file.string()},
                    {"folder", file.parent_path().string()},
                    {"refused", std::move(refused)}};
  };
  for (const TechniquePlugin* plugin : registry.all()) add(plugin->info->name, nullptr);
  for (const auto& refusal : registry.refused()) add(refusal.name, refusal.reason);
  nlohmann::ordered_json sorted = nlohmann::ordered_json::array();
  for (auto& [name, module] : byName) sorted.push_back(std::move(module));
  return sorted;
}

void printModules(const nlohmann::ordered_json& modules) {
  fmt::print("techniques\n");
  for (const auto& module : modules) {
    const std::string name = module["name"], file = module["file"];
    if (module["refused"].is_null())
      fmt::print("  {}: {}\n", name, file);
    else
      fmt::print("  {}: refused: {}\n", name, module["refused"].get<std::string>());
  }
}

const char* lightTypeName(const glsl::Light& light) {
  switch (light.type) {
    case glsl::light_rectangle:
      return "rectangle";
    case glsl::light_directional:
      return "directional";
    case glsl::light_spot:
      return "spot";
    default:
      return "point";
  }
}

/// Where a camera stands and looks, in the world of the file.
nlohmann::ordered_json describe(const scene::CameraPose& camera, const glm::dvec3& origin) {
  const glm::dmat4 toWorld = glm::inverse(glm::dmat4(camera.worldToView));
  const auto vector = [](const glm::dvec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  return {{"name", camera.name},
          {"eye_m", vector(glm::dvec3(toWorld[3]) + origin)},
          {"direction", vector(-glm::dvec3(toWorld[2]))},
          {"up", vector(glm::dvec3(toWorld[1]))},
          {"vertical_fov_degrees", glm::degrees(static_cast<double>(camera.yfov))}};
}

/// What the scene's file holds that options name.
nlohmann::ordered_json describe(const scene::Scene& scene) {
  const scene::Pose pose = scene::evaluate(scene, 0);
  nlohmann::ordered_json json{{"file", scene.file.string()},
                              {"triangles", scene.triangles()},
                              {"materials", scene.materials.size()},
                              {"textures", scene.images.size()},
                              {"size_m", nlohmann::ordered_json::array()}};
  const glm::vec3 side = pose.bounds.empty() ? glm::vec3(0) : pose.bounds.high - pose.bounds.low;
  for (int axis = 0; axis < 3; ++axis) json["size_m"].push_back(side[axis]);
  for (const char* key : {"cameras", "lights", "animations"}) json[key] = nlohmann::ordered_json::array();
  for (const scene::CameraPose& camera : pose.cameras)
    json["cameras"].push_back(describe(camera, pose.origin));
  for (std::size_t i = 0; i < pose.lights.size(); ++i) {
    const glsl::Light& light = pose.lights[i];
    nlohmann::ordered_json one{{"name", pose.lightNames[i]}, {"type", lightTypeName(light)}};
    if (light.type == glsl::light_rectangle) one["sides_m"] = {light.length_u, light.length_v};
    json["lights"].push_back(std::move(one));
  }
  for (std::size_t i = 0; i < scene.animations.size(); ++i) {
    const scene::Animation& animation = scene.animations[i];  // poses name cameras and lights, not these
    json["animations"].push_back({{"name", animation.name.empty() ? fmt::format("#{}", i) : animation.name},
                                  {"seconds", animation.duration}});
  }
  json["environment"] = static_cast<bool>(scene.environment);
  json["medium"] = scene.medium.present();
  return json;
}

/// Names with what is said of each in brackets, on one line.
std::string namesText(const nlohmann::ordered_json& things) {
  std::string text;
  for (const auto& thing : things) {
    text += (text.empty() ? "" : ", ") + thing["name"].get<std::string>();
    if (thing.contains("eye_m"))
      text += fmt::format(" (at {:.5g}, towards {:.4g}, {:.4g} degrees)",
                          fmt::join(thing["eye_m"].get<std::vector<double>>(), ","),
                          fmt::join(thing["direction"].get<std::vector<double>>(), ","),
                          thing["vertical_fov_degrees"].get<double>());
    else if (thing.contains("sides_m"))
      text += fmt::format(" (rectangle, {:.4g} x {:.4g} m)", thing["sides_m"][0].get<double>(),
                          thing["sides_m"][1].get<double>());
    else if (thing.contains("type"))
      text += fmt::format(" ({})", thing["type"].get<std::string>());
    else if (thing.contains("seconds"))
      text += fmt::format(" ({:.4g} s)", thing["seconds"].get<double>());
  }
  return text.empty() ? "none" : text;
}

void printScene(const nlohmann::ordered_json& scene) {
  const auto side = [&](std::size_t axis) { return scene["size_m"][axis].get<double>(); };
  fmt::print("{}: {} triangles, {} materials, {} textures, {:.4g} x {:.4g} x {:.4g} m\n",
             scene["file"].get<std::string>(), scene["triangles"].get<std::uint64_t>(),
             scene["materials"].get<std::size_t>(), scene["textures"].get<std::size_t>(), side(0), side(1),
             side(2));
  for (const char* key : {"cameras", "lights", "animations"})
    fmt::print("{}: {}\n", key, namesText(scene[key]));
  for (const char* key : {"environment", "medium"})
    fmt::print("{}: {}\n", key, scene[key].get<bool>() ? "the scene's own" : "none");
}

void runScene(const std::string& nameOrFile, bool json) {
  const scene::Scene scene = scene::load(session::findScene(nameOrFile));
  for (const std::string& warning : scene.warnings) warn(warning);
  const nlohmann::ordered_json described = describe(scene);
  if (json)
    printAsJson(described);
  else
    printScene(described);
}

}  // namespace

Action addInfoCommand(CLI::App& command) {
  auto json = std::make_shared<bool>(false);
  auto scene = std::make_shared<std::string>();
  command.add_option("scene", *scene,
                     "Say what this scene holds instead: cameras, lights and animations by the "
                     "names that options take, where cameras stand and look, and its size");
  command.add_flag("--json", *json, "Print JSON");
  return [json, scene] {
    if (!scene->empty()) {
      runScene(*scene, *json);
      return 0;
    }
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const DeviceDescription& device : listDevices()) devices.push_back(describe(device));
    const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
    const nlohmann::ordered_json techniques = modules(registry);
    if (*json) {
      printAsJson({{"version", version()}, {"devices", devices}, {"techniques", techniques}});
    } else {
      for (const auto& device : devices) printDevice(device);
      printModules(techniques);
    }
    return 0;
  };
}

}  // namespace limn::app
