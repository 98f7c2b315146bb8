#include "core/bench/machine.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <fstream>
#include <thread>

namespace limn::bench {
namespace {

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

std::string machineName() {
  utsname system{};
  ::uname(&system);
  return fmt::format("{}, {} threads, {} {}", processorName(), std::thread::hardware_concurrency(),
                     system.sysname, system.machine);
}

}  // namespace limn::bench
