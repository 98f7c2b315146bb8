// Numbers out of accessors. Every range is checked against the bytes that are there before anything is
// allocated.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

template <class T>
T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// One component as float; normalised integers as glTF 2.0, section 3.11, says.
float toFloat(const std::byte* bytes, int type, bool normalised) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load<float>(bytes);
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = load<std::int8_t>(bytes);
      return normalised ? std::max(value / 127.f, -1.f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float value = load<std::uint8_t>(bytes);
      return normalised ? value / 255.f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = load<std::int16_t>(bytes);
      return normalised ? std::max(value / 32767.f, -1.f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float value = load<std::uint16_t>(bytes);
      return normalised ? value / 65535.f : value;
    }
    default: {
      const float value = static_cast<float>(load<std::uint32_t>(bytes));
      return normalised ? value / 4294967295.f : value;
    }
  }
}

std::uint32_t toInteger(const std::byte* bytes, int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return load<std::uint8_t>(bytes);
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<std::uint16_t>(bytes);
  return load<std::uint32_t>(bytes);
}

bool isUnsigned(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

bool isKnown(int type) {
  return isUnsigned(type) || type == TINYGLTF_COMPONENT_TYPE_FLOAT || type == TINYGLTF_COMPONENT_TYPE_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_SHORT;
}

}  // namespace

const tinygltf::Accessor& Loader::accessorAt(int index, const std::string& what) const {
  if (index < 0 || static_cast<std::size_t>(index) >= model_->accessors.size())
    fail(fmt::format("{}: accessor {} does not exist; there are {}", what, index, model_->accessors.size()));
  const tinygltf::Accessor& accessor = model_->accessors[static_cast<std::size_t>(index)];
  if (!isKnown(accessor.componentType))
    fail(fmt::format("{}: component type {} is not one of glTF 2.0", what, accessor.componentType));
  return accessor;
}

std::span<const std::byte> Loader::bufferBytes(int index, std::uint64_t offset, std::uint64_t length,
                                               const std::string& what) const {
  if (index < 0 || static_cast<std::size_t>(index) >= buffers_.size())
    fail(fmt::format("{}: buffer {} does not exist; there are {}", what, index, buffers_.size()));
  const std::span<const std::byte> buffer = buffers_[static_cast<std::size_t>(index)];
  if (offset > buffer.size() || length > buffer.size() - offset)
    fail(fmt::format("{} covers {} bytes from {}, buffer {} has {}", what, length, offset, index,
                     buffer.size()));
  return buffer.subspan(offset, length);
}

std::span<const std::byte> Loader::viewBytes(int view, const std::string& what) const {
  if (view < 0 || static_cast<std::size_t>(view) >= model_->bufferViews.size())
    fail(fmt::format("{}: buffer view {} does not exist; there are {}", what, view,
                     model_->bufferViews.size()));
  const tinygltf::BufferView& source = model_->bufferViews[static_cast<std::size_t>(view)];
  return bufferBytes(source.buffer, source.byteOffset, source.byteLength,
                     fmt::format("{}: buffer view {}", what, view));
}

template <class Store>
void Loader::forEachElement(const tinygltf::Accessor& accessor, int components, std::int64_t expected,
                            const std::string& what, Store store) {
  const std::size_t componentBytes = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
  const std::size_t elementBytes = componentBytes * static_cast<std::size_t>(components);
  if (expected >= 0 && accessor.count != static_cast<std::uint64_t>(expected))
    fail(fmt::format("{}: {} elements where {} are needed", what, accessor.count, expected));
  if (accessor.bufferView >= 0) {
    const auto bytes = viewBytes(accessor.bufferView, what);
    const std::size_t declared =
        model_->bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    const std::size_t stride = declared == 0 ? elementBytes : declared;
    const bool fits = stride >= elementBytes && accessor.byteOffset <= bytes.size() &&
                      (accessor.count == 0 ||
                       (bytes.size() - accessor.byteOffset >= elementBytes &&
                        (bytes.size() - accessor.byteOffset - elementBytes) / stride >= accessor.count - 1));
    if (!fits)
      fail(fmt::format(
          "{}: {} elements of {} bytes, {} apart, from byte {} do not fit into the {} bytes of buffer "
          "view {}",
          what, accessor.count, elementBytes, stride, accessor.byteOffset, bytes.size(),
          accessor.bufferView));
    spend(accessor.count, what);
    const std::byte* element = bytes.data() + accessor.byteOffset;
    for (std::size_t i = 0; i < accessor.count; ++i) store(i, element + i * stride);
  } else {
    if (expected < 0) fail(fmt::format("{}: the accessor has no buffer view", what));
    spend(accessor.count, what);
    const std::vector<std::byte> zero(elementBytes);
    for (std::size_t i = 0; i < accessor.count; ++i) store(i, zero.data());
  }
  if (accessor.sparse.isSparse) forEachSparse(accessor, elementBytes, what, store);
}

template <class Store>
void Loader::forEachSparse(const tinygltf::Accessor& accessor, std::size_t elementBytes,
                           const std::string& what, Store store) const {
  const auto& sparse = accessor.sparse;
  const auto offsetIn = [&](std::span<const std::byte> bytes, int offset, std::size_t needed) {
    if (offset < 0 || static_cast<std::size_t>(offset) > bytes.size() ||
        needed > bytes.size() - static_cast<std::size_t>(offset))
      fail(fmt::format("{}: sparse data of {} bytes from byte {} does not fit into {} bytes", what, needed,
                       offset, bytes.size()));
    return bytes.data() + offset;
  };
  if (sparse.count < 0 || static_cast<std::uint64_t>(sparse.count) > accessor.count)
    fail(fmt::format("{}: {} sparse elements for {} elements", what, sparse.count, accessor.count));
  if (!isUnsigned(sparse.indices.componentType))
    fail(fmt::format("{}: sparse indices of component type {}", what, sparse.indices.componentType));
  const std::size_t count = static_cast<std::size_t>(sparse.count);
  const std::size_t indexBytes = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(sparse.indices.componentType)));
  const std::byte* indices =
      offsetIn(viewBytes(sparse.indices.bufferView, what), sparse.indices.byteOffset, count * indexBytes);
  const std::byte* values =
      offsetIn(viewBytes(sparse.values.bufferView, what), sparse.values.byteOffset, count * elementBytes);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = toInteger(indices + i * indexBytes, sparse.indices.componentType);
    if (index >= accessor.count)
      fail(fmt::format("{}: sparse index {} of {} elements", what, index, accessor.count));
    store(index, values + i * elementBytes);
  }
}

Floats Loader::readFloats(int index, std::initializer_list<int> components, std::int64_t expected,
                          const std::string& what) {
  const std::string place = fmt::format("{} (accessor {})", what, index);
  const tinygltf::Accessor& accessor = accessorAt(index, place);
  Floats out;
  out.components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (std::find(components.begin(), components.end(), out.components) == components.end())
    fail(fmt::format("{}: {} components per element; {} are accepted", place, out.components,
                     fmt::join(components, " or ")));
  if (out.components == 16 || out.components == 9) {
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
      fail(fmt::format("{}: matrices must be floats", place));
  }
  out.count = accessor.count;
  const std::size_t perElement = static_cast<std::size_t>(out.components);
  const std::size_t componentBytes = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
  forEachElement(accessor, out.components, expected, place, [&](std::size_t i, const std::byte* element) {
    // The first element arrives after the range checks: only now is the size to be trusted.
    if (out.values.empty()) out.values.resize(accessor.count * perElement);
    for (std::size_t c = 0; c < perElement; ++c) {
      const float value = toFloat(element + c * componentBytes, accessor.componentType, accessor.normalized);
      if (!std::isfinite(value)) fail(fmt::format("{}: element {} is not a finite number", place, i));
      out.values[i * perElement + c] = value;
    }
  });
  return out;
}

std::vector<std::uint32_t> Loader::readIntegers(int index, int components, std::int64_t expected,
                                                const std::string& what) {
  const std::string place = fmt::format("{} (accessor {})", what, index);
  const tinygltf::Accessor& accessor = accessorAt(index, place);
  const int found = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (found != components || !isUnsigned(accessor.componentType))
    fail(fmt::format("{}: {} component(s) of type {}; {} unsigned integer(s) are accepted", place, found,
                     accessor.componentType, components));
  const std::size_t perElement = static_cast<std::size_t>(components);
  const std::size_t componentBytes = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
  std::vector<std::uint32_t> out;
  forEachElement(accessor, components, expected, place, [&](std::size_t i, const std::byte* element) {
    if (out.empty()) out.resize(accessor.count * perElement);
    for (std::size_t c = 0; c < perElement; ++c)
      out[i * perElement + c] = toInteger(element + c * componentBytes, accessor.componentType);
  });
  return out;
}

}  // namespace limn::scene
