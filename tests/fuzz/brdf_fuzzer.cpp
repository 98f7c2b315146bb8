// libFuzzer target of measured BRDFs: any bytes are read as a file of MERL with few nodes and as one of the
// RGL, and end in a table of numbers or in limn::Error of one line.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/brdf/epfl_file.h"
#include "core/brdf/merl_file.h"

namespace {

using limn::brdf::TabulatedBrdf;

constexpr glm::ivec3 kNodes{4, 3, 2};

void require(bool condition) {
  if (!condition) std::abort();
}

template <class Read>
void attempt(Read read) {
  try {
    const TabulatedBrdf table = read();
    require(table.size == kNodes && table.values.size() == 24);
    for (const glm::vec3& f : table.values)
      for (int channel = 0; channel < 3; ++channel)
        require(f[channel] >= 0 && f[channel] <= 1.001f * limn::brdf::kLargestValue);
  } catch (const limn::Error& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    require(std::string_view(error.what()).starts_with("brdf: "));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  attempt([&] { return limn::brdf::decodeMerl(bytes, "brdf", kNodes); });
  attempt([&] { return limn::brdf::decodeEpfl(bytes, "brdf", kNodes); });
  return 0;
}
