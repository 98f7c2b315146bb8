// Internal to core/brdf: takes apart the container of the RGL's BRDF files, "tensor_file" of version 1.0:
// named arrays of any shape, little-endian. All of it is checked against the bytes that are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn::brdf {

/// How the numbers of an array are kept, by the format's numbers of types.
enum class TensorType : std::uint8_t { half = 9, float32 = 10 };

/// An array of floating-point numbers, the last index fastest.
struct Tensor {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

class TensorFile {
 public:
  /// Keeps `bytes`. Throws Error that begins with `name` where they are no such file, or where an array lies
  /// outside.
  TensorFile(std::span<const std::byte> bytes, std::string_view name);

  /// Returns whether there is an array of that name.
  bool has(std::string_view field) const { return fields_.contains(field); }

  /// Returns the array of that name. Throws Error where there is none, or where it is neither of type half
  /// nor float, has another number of dimensions, or is empty.
  Tensor floats(std::string_view field, std::size_t dimensions) const;

 private:
  struct Field {
    int type = 0;
    std::vector<std::size_t> shape;
    std::span<const std::byte> data;
  };
  std::string name_;
  std::map<std::string, Field, std::less<>> fields_;
};

/// Returns whether a content begins as one of these files.
bool isTensorFile(std::span<const std::byte> bytes);

/// Returns the content of a file with one array. Numbers beyond 65504 are none of type half.
std::vector<std::byte> encodeTensorFile(std::string_view field, const Tensor& tensor, TensorType type);

}  // namespace limn::brdf
