#include "core/brdf/measured_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/brdf/epfl_file.h"
#include "core/brdf/merl_file.h"
#include "core/brdf/private/tensor_file.h"

namespace limn::brdf {
namespace {

constexpr std::string_view kField = "disc_pairs";
constexpr std::size_t kDimensions = 5;
constexpr float kLargestHalf = 65504;

/// Says whether a file is called .bsdf: scenes have the names of their files in quotes.
bool isBsdf(std::string_view name) {
  if (name.ends_with('\'')) name.remove_suffix(1);
  return name.ends_with(".bsdf");
}

bool isSide(std::size_t texels) {
  return texels >= 1 && texels <= static_cast<std::size_t>(kMostDiscTexels);
}

AnisotropicTable discPairs(const TensorFile& file, std::string_view name) {
  const Tensor tensor = file.floats(kField, kDimensions);
  const std::vector<std::size_t>& shape = tensor.shape;
  if (!isSide(shape[0]) || shape != std::vector<std::size_t>{shape[0], shape[0], shape[0], shape[0], 3})
    throw Error(
        fmt::format("{}: array '{}' is {} x {} x {} x {} x {}; N x N x N x N x 3 with N from 1 to {} "
                    "is accepted",
                    name, kField, shape[0], shape[1], shape[2], shape[3], shape[4], kMostDiscTexels));
  AnisotropicTable table{.size = static_cast<int>(shape[0]),
                         .values = std::vector<glm::vec3>(tensor.values.size() / 3)};
  for (std::size_t i = 0; i < tensor.values.size(); ++i) {
    const float value = tensor.values[i];
    if (!(value >= 0 && value <= kLargestValue))
      throw Error(fmt::format("{}: array '{}' holds {}; numbers from 0 to {:g} are accepted", name, kField,
                              value, kLargestValue));
    table.values[i / 3][static_cast<int>(i % 3)] = value;
  }
  return table;
}

}  // namespace

MeasuredBrdf decodeMeasured(std::span<const std::byte> bytes, std::string_view name) {
  if (!isTensorFile(bytes) && !isBsdf(name)) return decodeMerl(bytes, name);
  const TensorFile file(bytes, name);
  if (file.has(kField)) return discPairs(file, name);
  return decodeEpfl(bytes, name);
}

MeasuredBrdf readMeasured(const std::filesystem::path& path) {
  return decodeMeasured(readFile(path, kLargestMeasuredFile), path.string());
}

AnisotropicTable decodeDiscPairs(std::span<const std::byte> bytes, std::string_view name) {
  return discPairs(TensorFile(bytes, name), name);
}

std::vector<std::byte> encodeMeasured(const AnisotropicTable& table, MeasuredFormat format) {
  const std::size_t side = table.size < 0 ? 0 : static_cast<std::size_t>(table.size);
  if (!isSide(side) || table.values.size() != side * side * side * side)
    throw Error(
        fmt::format("a table of {} texels a side and {} values; 1 to {} and their fourth power are "
                    "accepted",
                    table.size, table.values.size(), kMostDiscTexels));
  const float largest = format == MeasuredFormat::half ? kLargestHalf : kLargestValue;
  Tensor tensor{.shape = {side, side, side, side, 3}, .values = {}};
  tensor.values.reserve(3 * table.values.size());
  for (const glm::vec3& f : table.values)
    for (int channel = 0; channel < 3; ++channel) {
      if (!(f[channel] >= 0 && f[channel] <= largest))
        throw Error(
            fmt::format("a table that holds {}; numbers from 0 to {:g} are accepted", f[channel], largest));
      tensor.values.push_back(f[channel]);
    }
  return encodeTensorFile(kField, tensor,
                          format == MeasuredFormat::half ? TensorType::half : TensorType::float32);
}

void writeMeasured(const std::filesystem::path& path, const AnisotropicTable& table, MeasuredFormat format) {
  std::vector<std::byte> bytes;
  try {
    bytes = encodeMeasured(table, format);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path.string(), error.what()));
  }
  writeFile(path, bytes);
}

}  // namespace limn::brdf
