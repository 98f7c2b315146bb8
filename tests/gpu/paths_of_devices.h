// Has tests choose between the paths for GPUs and those for software renderers (gpu::Device::software()).
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace limn {

/// Has devices that are made while it lives take the paths for GPUs, or those that their renderer is for.
class PathsOfDevices {
 public:
  explicit PathsOfDevices(bool hardware) {
    if (const char* value = std::getenv(kName)) before_ = value;
    set(hardware ? std::optional<std::string>("1") : std::nullopt);
  }
  ~PathsOfDevices() { set(before_); }
  PathsOfDevices(const PathsOfDevices&) = delete;
  PathsOfDevices& operator=(const PathsOfDevices&) = delete;

 private:
  static constexpr const char* kName = "LIMN_HARDWARE_PATHS";
  static void set(const std::optional<std::string>& value) {
    value ? setenv(kName, value->c_str(), 1) : unsetenv(kName);
  }
  std::optional<std::string> before_;
};

}  // namespace limn
