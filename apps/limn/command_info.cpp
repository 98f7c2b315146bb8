// limn info: what this machine offers.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/gpu/device.h"

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

void printText(const nlohmann::ordered_json& device) {
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

}  // namespace

Action addInfoCommand(CLI::App& command) {
  auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "Print JSON");
  return [json] {
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const DeviceDescription& device : listDevices()) devices.push_back(describe(device));
    if (*json)
      fmt::print("{}\n", nlohmann::ordered_json{{"version", LIMN_VERSION}, {"devices", devices}}.dump(2));
    else
      for (const auto& device : devices) printText(device);
    return 0;
  };
}

}  // namespace limn::app
