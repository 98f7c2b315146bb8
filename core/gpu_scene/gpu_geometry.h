// Declares the vertex and index memory of a GpuScene: shared streams that only grow.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/gpu/objects.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Says where a primitive lies in the streams.
struct GeometryRange {
  uint32_t firstVertex = 0, vertexCount = 0;
  uint32_t firstIndex = 0, indexCount = 0;
};

/// Throws UsageError where shaders could not reach all of a buffer that holds `bytes` of `what`, of which
/// there are too many in `where`.
void checkStorageBlock(const gpu::Device& device, const char* what, uint64_t bytes,
                       const char* where = "scene");

class GpuGeometry {
 public:
  /// Uploads every primitive of every mesh. Throws UsageError, before memory is taken, beyond 2^32 vertices
  /// or indices and beyond what a storage block holds of them, and Error when out of memory.
  GpuGeometry(gpu::Device& device, const Scene& scene);

  const GeometryRange& primitive(int mesh, int primitive) const {
    return ranges_[meshOffsets_[static_cast<size_t>(mesh)] + static_cast<size_t>(primitive)];
  }
  /// Returns a number that identifies a primitive among all.
  uint32_t primitiveIndex(int mesh, int primitive) const {
    return static_cast<uint32_t>(meshOffsets_[static_cast<size_t>(mesh)] + static_cast<size_t>(primitive));
  }
  uint32_t primitiveCount() const { return static_cast<uint32_t>(ranges_.size()); }

  /// Grows the buffers to hold these numbers of vertices and indices after the scene's own, keeps their
  /// contents, and releases everything that was allocated there. Throws as the constructor does; nothing is
  /// released then.
  void reserve(uint64_t vertices, uint64_t indices);
  /// Allocates reserved space for deformed and dynamic primitives, and returns the first index of it.
  uint32_t allocateVertices(uint32_t count);
  uint32_t allocateIndices(uint32_t count);
  /// Copies the colours of the scene's own range to the allocated range whose vertices are deformed from it.
  void copyColours(const GeometryRange& source, const GeometryRange& target);
  /// Writes a dynamic primitive into its allocated range.
  void write(const GeometryRange& range, const Primitive& primitive);

  const gpu::Buffer& positions() const { return positions_; }
  const gpu::Buffer& attributes() const { return attributes_; }
  const gpu::Buffer& indices() const { return indices_; }
  const gpu::Buffer& colours() const { return colours_; }
  bool hasColours() const { return hasColours_; }

 private:
  void checkSizes(uint64_t vertices, uint64_t indices) const;

  gpu::Device& device_;
  std::vector<GeometryRange> ranges_;
  std::vector<size_t> meshOffsets_;
  uint64_t sceneVertices_ = 0, sceneIndices_ = 0;
  uint64_t vertices_ = 0, indexCount_ = 0;
  bool hasColours_ = false;
  bool deforms_ = false;  ///< skins or morph targets: a shader reads the attributes as well
  bool dynamic_ = false;
  gpu::Buffer positions_, attributes_, colours_, indices_;
};

}  // namespace limn::scene
