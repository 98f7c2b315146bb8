// libFuzzer target of measured BRDFs: any bytes are read as a file of MERL with few nodes, as one of the
// RGL and as one over two directions, and end in a table of numbers or in limn::Error of one line.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "core/base/error.h"
#include "core/brdf/epfl_file.h"
#include "core/brdf/measured_file.h"
#include "core/brdf/merl_file.h"

namespace {

using limn::brdf::AnisotropicTable;
using limn::brdf::TabulatedBrdf;

constexpr glm::ivec3 kNodes{4, 3, 2};

void require(bool condition) {
  if (!condition) std::abort();
}

void requireValues(const std::vector<glm::vec3>& values, std::size_t count, float largest) {
  require(values.size() == count);
  for (const glm::vec3& f : values)
    for (int channel = 0; channel < 3; ++channel) require(f[channel] >= 0 && f[channel] <= largest);
}

template <class Read>
void attempt(Read read) {
  try {
    read();
  } catch (const limn::Error& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    require(std::string_view(error.what()).starts_with("brdf: "));
  }
}

void requireNodes(const TabulatedBrdf& table) {
  require(table.size == kNodes);
  requireValues(table.values, 24, 1.001f * limn::brdf::kLargestValue);
}

void requireTexels(const AnisotropicTable& table) {
  const auto side = static_cast<std::size_t>(table.size);
  require(table.size >= 1 && table.size <= limn::brdf::kMostDiscTexels);
  requireValues(table.values, side * side * side * side, limn::brdf::kLargestValue);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  attempt([&] { requireNodes(limn::brdf::decodeMerl(bytes, "brdf", kNodes)); });
  attempt([&] {
    const limn::brdf::MeasuredBrdf read =
        limn::brdf::decodeEpfl(bytes, "brdf", {.angles = kNodes, .texels = 3});
    if (const auto* isotropic = std::get_if<TabulatedBrdf>(&read)) return requireNodes(*isotropic);
    requireTexels(std::get<AnisotropicTable>(read));
  });
  attempt([&] { requireTexels(limn::brdf::decodeDiscPairs(bytes, "brdf")); });
  return 0;
}
