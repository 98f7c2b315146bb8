#include "core/gpu_scene/gpu_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "core/base/error.h"
#include "glsl/geometry/vertex.glsl"

namespace limn::scene {
namespace {

constexpr size_t kPositionBytes = 3 * sizeof(float);
constexpr size_t kAttributeBytes = sizeof(glsl::VertexAttributes);
constexpr size_t kColourBytes = 4 * sizeof(uint16_t);
static_assert(kAttributeBytes == 16);

glsl::VertexAttributes packVertex(const Primitive& primitive, size_t i) {
  glsl::VertexAttributes a{};
  const glm::vec3 normal = i < primitive.normals.size() ? primitive.normals[i] : glm::vec3(0, 0, 1);
  a.normal = glsl::vertex_pack_normal(glm::dot(normal, normal) > 0 ? normal : glm::vec3(0, 0, 1));
  if (i < primitive.tangents.size() && glm::dot(primitive.tangents[i], primitive.tangents[i]) > 1)
    a.tangent = glsl::vertex_pack_tangent(primitive.tangents[i]);
  if (i < primitive.uvs.size()) {
    a.u = primitive.uvs[i].x;
    a.v = primitive.uvs[i].y;
  }
  return a;
}

std::vector<glsl::VertexAttributes> packAttributes(const Primitive& primitive) {
  std::vector<glsl::VertexAttributes> packed(primitive.positions.size());
  for (size_t i = 0; i < packed.size(); ++i) packed[i] = packVertex(primitive, i);
  return packed;
}

/// Halves: dark colours keep as many digits as light ones.
std::vector<glm::u16vec4> packColours(const Primitive& primitive) {
  std::vector<glm::u16vec4> packed(primitive.positions.size(), glm::packHalf(glm::vec4(1)));
  for (size_t i = 0; i < std::min(packed.size(), primitive.colours.size()); ++i)
    packed[i] = glm::packHalf(glm::clamp(primitive.colours[i], 0.f, 1.f));
  return packed;
}

void checkCount(uint64_t count, const char* what) {
  if (count > std::numeric_limits<uint32_t>::max())
    throw UsageError(fmt::format("scene: {} {} are more than the {} that can be drawn", count, what,
                                 std::numeric_limits<uint32_t>::max()));
}

/// A buffer filled piece by piece while the scene is uploaded.
class Upload {
 public:
  Upload(gpu::Device& device, const char* label, size_t bytes, gpu::BufferUse use)
      : target_(device, label, bytes, use), device_(device) {}
  void append(const void* data, size_t bytes) {
    if (bytes == 0) return;
    const gpu::Buffer staging(device_, "staging", bytes, gpu::BufferUse::fixed, data);
    device_.gl().CopyNamedBufferSubData(staging.id(), target_.id(), 0, static_cast<GLintptr>(offset_),
                                        static_cast<GLsizeiptr>(bytes));
    offset_ += bytes;
  }
  gpu::Buffer take() { return std::move(target_); }

 private:
  gpu::Buffer target_;
  gpu::Device& device_;
  size_t offset_ = 0;
};

/// To what is asked for and no more: what changes in size asks for powers of two, and most of the buffer may
/// be geometry that does not.
void grow(gpu::Buffer& buffer, const char* label, size_t bytes, gpu::BufferUse use) {
  if (bytes <= buffer.size()) return;
  gpu::Buffer larger(buffer.device(), label, bytes, use);
  buffer.device().gl().CopyNamedBufferSubData(buffer.id(), larger.id(), 0, 0,
                                              static_cast<GLsizeiptr>(buffer.size()));
  buffer = std::move(larger);
}

}  // namespace

void checkStorageBlock(const gpu::Device& device, const char* what, uint64_t bytes, const char* where) {
  const auto most = static_cast<uint64_t>(device.limits().maxStorageBlockBytes);
  if (bytes > most)
    throw UsageError(fmt::format("{}: {} take {} MiB, more than the {} MiB of a storage buffer", where, what,
                                 bytes >> 20, most >> 20));
}

GpuGeometry::GpuGeometry(gpu::Device& device, const Scene& scene)
    : device_(device), dynamic_(!scene.dynamic.empty()) {
  for (const Mesh& mesh : scene.meshes) {
    meshOffsets_.push_back(ranges_.size());
    for (const Primitive& primitive : mesh.primitives) {
      const uint64_t vertices = primitive.positions.size(), indices = primitive.indices.size();
      ranges_.push_back({static_cast<uint32_t>(sceneVertices_), static_cast<uint32_t>(vertices),
                         static_cast<uint32_t>(sceneIndices_), static_cast<uint32_t>(indices)});
      sceneVertices_ += vertices;
      sceneIndices_ += indices;
      hasColours_ = hasColours_ || !primitive.colours.empty();
      deforms_ = deforms_ || !primitive.joints.empty() || !primitive.morphTargets.empty();
    }
  }
  checkSizes(sceneVertices_, sceneIndices_);
  const auto use = dynamic_ ? gpu::BufferUse::updated : gpu::BufferUse::fixed;
  Upload positions(device, "vertex positions", sceneVertices_ * kPositionBytes, use);
  Upload attributes(device, "vertex attributes", sceneVertices_ * kAttributeBytes, use);
  Upload colours(device, "vertex colours", hasColours_ ? sceneVertices_ * kColourBytes : 0, use);
  Upload indices(device, "indices", sceneIndices_ * sizeof(uint32_t), use);
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& primitive : mesh.primitives) {
      positions.append(primitive.positions.data(), primitive.positions.size() * kPositionBytes);
      attributes.append(packAttributes(primitive).data(), primitive.positions.size() * kAttributeBytes);
      indices.append(primitive.indices.data(), primitive.indices.size() * sizeof(uint32_t));
      if (hasColours_)
        colours.append(packColours(primitive).data(), primitive.positions.size() * kColourBytes);
    }
  }
  positions_ = positions.take();
  attributes_ = attributes.take();
  colours_ = colours.take();
  indices_ = indices.take();
}

void GpuGeometry::checkSizes(uint64_t vertices, uint64_t indices) const {
  checkCount(vertices, "vertices");
  checkCount(indices, "indices");
  checkStorageBlock(device_, "positions of vertices", vertices * kPositionBytes);
  checkStorageBlock(device_, "indices of triangles", indices * sizeof(uint32_t));
  if (deforms_) checkStorageBlock(device_, "attributes of vertices", vertices * kAttributeBytes);
}

void GpuGeometry::reserve(uint64_t vertices, uint64_t indices) {
  vertices += sceneVertices_;
  indices += sceneIndices_;
  checkSizes(vertices, indices);
  const auto use = dynamic_ ? gpu::BufferUse::updated : gpu::BufferUse::fixed;
  grow(positions_, "vertex positions", vertices * kPositionBytes, use);
  grow(attributes_, "vertex attributes", vertices * kAttributeBytes, use);
  if (hasColours_) grow(colours_, "vertex colours", vertices * kColourBytes, use);
  grow(indices_, "indices", indices * sizeof(uint32_t), use);
  vertices_ = sceneVertices_;
  indexCount_ = sceneIndices_;
}

uint32_t GpuGeometry::allocateVertices(uint32_t count) {
  vertices_ += count;
  return static_cast<uint32_t>(vertices_ - count);
}

uint32_t GpuGeometry::allocateIndices(uint32_t count) {
  indexCount_ += count;
  return static_cast<uint32_t>(indexCount_ - count);
}

void GpuGeometry::copyColours(const GeometryRange& source, const GeometryRange& target) {
  if (!hasColours_ || source.vertexCount == 0) return;
  device_.gl().CopyNamedBufferSubData(colours_.id(), colours_.id(),
                                      static_cast<GLintptr>(source.firstVertex * kColourBytes),
                                      static_cast<GLintptr>(target.firstVertex * kColourBytes),
                                      static_cast<GLsizeiptr>(source.vertexCount * kColourBytes));
}

void GpuGeometry::write(const GeometryRange& range, const Primitive& primitive) {
  const size_t count = primitive.positions.size();
  positions_.update(range.firstVertex * kPositionBytes, primitive.positions.data(), count * kPositionBytes);
  attributes_.update(range.firstVertex * kAttributeBytes, packAttributes(primitive).data(),
                     count * kAttributeBytes);
  if (hasColours_)
    colours_.update(range.firstVertex * kColourBytes, packColours(primitive).data(), count * kColourBytes);
  indices_.update(range.firstIndex * sizeof(uint32_t), primitive.indices.data(),
                  primitive.indices.size() * sizeof(uint32_t));
}

}  // namespace limn::scene
