// libFuzzer target of bench suites: any text is either a suite, or ends in limn::UsageError of one line.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/bench/suite.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    for (const limn::bench::Case& c :
         limn::bench::parseSuite({reinterpret_cast<const char*>(data), size}, "suite.toml").cases)
      if (c.scene.empty() || c.width < 1 || c.height < 1) std::abort();
  } catch (const limn::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
