#include "core/brdf/private/tensor_file.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn::brdf {
namespace {

constexpr std::string_view kMagic("tensor_file\0", 12);
constexpr std::array<std::uint8_t, 2> kVersion{1, 0};
/// Bytes of an element of each type: none, then 8 to 64 bits without and with sign in turn, then half, float,
/// double.
constexpr std::array<std::uint64_t, 12> kTypeBytes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
constexpr std::size_t kMostDimensions = 8;

/// Takes a file apart from its beginning.
class Cursor {
 public:
  Cursor(std::span<const std::byte> bytes, std::string_view name) : rest_(bytes), name_(name) {}

  std::span<const std::byte> take(std::size_t count) {
    if (count > rest_.size())
      throw Error(fmt::format("{}: a BRDF file that ends within its table of arrays", name_));
    const std::span<const std::byte> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  template <class Number>
  Number number() {
    Number value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text(std::size_t count) {
    const std::span<const std::byte> taken = take(count);
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

 private:
  std::span<const std::byte> rest_;
  std::string_view name_;
};

}  // namespace

TensorFile::TensorFile(std::span<const std::byte> bytes, std::string_view name) : name_(name) {
  if (!isTensorFile(bytes))
    throw Error(
        fmt::format("{}: not a BRDF file of the RGL: it begins with another word than 'tensor_file'", name));
  Cursor cursor(bytes.subspan(kMagic.size()), name);
  if (const auto version = cursor.number<std::array<std::uint8_t, 2>>(); version != kVersion)
    throw Error(
        fmt::format("{}: a BRDF file of version {}.{}; 1.0 is accepted", name, version[0], version[1]));
  const auto count = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string title = cursor.text(cursor.number<std::uint16_t>());
    const auto dimensions = cursor.number<std::uint16_t>();
    const auto type = cursor.number<std::uint8_t>();
    const auto offset = cursor.number<std::uint64_t>();
    if (type == 0 || type >= kTypeBytes.size())
      throw Error(
          fmt::format("{}: array '{}' is of type {}; 1 to 11 are accepted", name, oneLine(title, 40), type));
    if (dimensions > kMostDimensions)
      throw Error(fmt::format("{}: array '{}' has {} dimensions; at most {} are accepted", name,
                              oneLine(title, 40), dimensions, kMostDimensions));
    Field field{.type = type, .shape = {}, .data = {}};
    const std::uint64_t room = offset <= bytes.size() ? bytes.size() - offset : 0;
    std::uint64_t size = kTypeBytes[type];
    for (std::uint16_t d = 0; d < dimensions; ++d) {
      const auto side = cursor.number<std::uint64_t>();
      field.shape.push_back(side);
      // No product overflows: what has outgrown the file stays there.
      size = side != 0 && size > room / side ? room + 1 : size * side;
    }
    if (offset > bytes.size() || size > room)
      throw Error(fmt::format("{}: array '{}' lies beyond the {} bytes of the file", name, oneLine(title, 40),
                              bytes.size()));
    field.data = bytes.subspan(offset, size);
    fields_.insert_or_assign(title, std::move(field));
  }
}

Tensor TensorFile::floats(std::string_view field, std::size_t dimensions) const {
  const auto found = fields_.find(field);
  if (found == fields_.end())
    throw Error(fmt::format("{}: a BRDF file without the array '{}'", name_, field));
  const Field& array = found->second;
  const bool half = array.type == static_cast<int>(TensorType::half);
  if ((!half && array.type != static_cast<int>(TensorType::float32)) || array.shape.size() != dimensions ||
      array.data.empty())
    throw Error(fmt::format(
        "{}: array '{}' has {} dimensions of type {} and {} bytes; {} of type 9 or 10 (half, float) are "
        "accepted, none of them empty",
        name_, field, array.shape.size(), array.type, array.data.size(), dimensions));
  Tensor tensor{.shape = array.shape, .values = {}};
  if (half) {
    std::vector<std::uint16_t> halves(array.data.size() / sizeof(std::uint16_t));
    std::memcpy(halves.data(), array.data.data(), array.data.size());
    tensor.values.reserve(halves.size());
    for (const std::uint16_t value : halves) tensor.values.push_back(glm::unpackHalf1x16(value));
  } else {
    tensor.values.resize(array.data.size() / sizeof(float));
    std::memcpy(tensor.values.data(), array.data.data(), array.data.size());
  }
  return tensor;
}

bool isTensorFile(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

std::vector<std::byte> encodeTensorFile(std::string_view field, const Tensor& tensor, TensorType type) {
  std::vector<std::byte> bytes;
  const auto put = [&](const void* from, std::size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  };
  const auto number = [&](auto value) { put(&value, sizeof value); };
  put(kMagic.data(), kMagic.size());
  put(kVersion.data(), kVersion.size());
  number(std::uint32_t{1});
  number(static_cast<std::uint16_t>(field.size()));
  put(field.data(), field.size());
  number(static_cast<std::uint16_t>(tensor.shape.size()));
  number(type);
  // The array follows its own offset and sides.
  number(static_cast<std::uint64_t>(bytes.size() + sizeof(std::uint64_t) * (1 + tensor.shape.size())));
  for (const std::size_t side : tensor.shape) number(static_cast<std::uint64_t>(side));
  if (type == TensorType::half)
    for (const float value : tensor.values) number(glm::packHalf1x16(value));
  else
    put(tensor.values.data(), tensor.values.size() * sizeof(float));
  return bytes;
}

}  // namespace limn::brdf
