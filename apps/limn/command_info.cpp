// limn info: what this machine offers, and which technique modules limn uses.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/version.h"
#include "core/gpu/device.h"
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

}  // namespace

Action addInfoCommand(CLI::App& command) {
  auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "Print JSON");
  return [json] {
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const DeviceDescription& device : listDevices()) devices.push_back(describe(device));
    const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
    const nlohmann::ordered_json techniques = modules(registry);
    if (*json) {
      fmt::print(
          "{}\n",
          nlohmann::ordered_json{{"version", version()}, {"devices", devices}, {"techniques", techniques}}
              .dump(2));
    } else {
      for (const auto& device : devices) printDevice(device);
      printModules(techniques);
    }
    return 0;
  };
}

}  // namespace limn::app
