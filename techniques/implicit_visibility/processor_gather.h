// Declares how leaves gather on the processor, for software renderers: their loads from storage buffers cost
// many times what the same loads cost a loop on the processor.
#pragma once

#include <span>
#include <vector>

#include "techniques/implicit_visibility/element_passes.h"

namespace limn::implicit_visibility {

/// Runs radiosity::gather() for one pass between buffers of the GPU. Buffers and memory are kept from frame
/// to frame.
class ProcessorGather {
 public:
  /// `elements` must outlive the object.
  ProcessorGather(gpu::Device& device, const ElementPasses& elements);

  /// Sets irradiance() to what arrives at leaves from `outgoing`, the radiance of each slot, and reflected()
  /// to what leaves then send on: `direct` and what they reflect of it. Reads both buffers back, which waits
  /// for the renderer.
  void gather(const gpu::Buffer& outgoing, const gpu::Buffer& direct);
  /// Sets irradiance() to what arrives through empty bins, each of which sees its value of `environment`.
  void gatherEnvironment(std::span<const glm::vec3> environment);

  /// Returns the irradiance of leaves, W/m^2.
  const gpu::Buffer& irradiance() const { return irradianceBuffer_; }
  /// Returns radiance, with room for all slots, of which those of leaves are set.
  const gpu::Buffer& reflected() const { return reflectedBuffer_; }

 private:
  /// Gathers into irradiance_ and uploads it.
  void gather(std::span<const glm::vec3> outgoing, std::span<const glm::vec3> environment);
  void read(const gpu::Buffer& buffer, size_t count);
  void upload(gpu::Buffer& buffer);

  const ElementPasses& elements_;
  std::vector<glm::vec4> exchange_;  ///< values of slots on their way from or to the GPU
  std::vector<glm::vec3> outgoing_, irradiance_;
  gpu::Buffer irradianceBuffer_, reflectedBuffer_;
};

}  // namespace limn::implicit_visibility
