// Declares morphing and skinning on the GPU: the rest data of every primitive that can be deformed, the state
// of this frame, and the compute pass that writes the deformed vertices.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/gpu_geometry.h"
#include "core/scene/scene.h"

namespace limn::scene {

class GpuDeform {
 public:
  /// Uploads the rest data. Throws UsageError where it is larger than a storage buffer of the device.
  GpuDeform(gpu::Device& device, const Scene& scene);

  /// Collects the state of all deformed primitives, whose vertices are written to `targets` (parallel to
  /// Pose::deformed). Returns true if anything changed since the last call. Throws as the constructor does.
  bool update(const Pose& pose, const GpuGeometry& geometry, const std::vector<GeometryRange>& targets);

  /// Declares the pass "deform", which writes the deformed ranges of `geometry`, and returns the new version.
  frame::BufferHandle addPass(frame::FrameGraph& graph, const GpuGeometry& streams,
                              frame::BufferHandle geometry);
  /// Marks the state as changed in the graph of the last addPass().
  void touch(frame::FrameGraph& graph) const;
  void forget();

 private:
  struct Rest {
    uint32_t skin = ~0u;   ///< first word in skin_
    uint32_t morph = ~0u;  ///< first float in morph_
    uint32_t targets = 0;
  };
  struct Job {
    uint32_t first_rest = 0;      ///< vertex
    uint32_t first_deformed = 0;  ///< vertex
    uint32_t vertices = 0;
    uint32_t skin = 0;  ///< first word of it, or ~0
    uint32_t first_joint = 0;
    uint32_t first_weight = 0;  ///< of the morph targets
    uint32_t targets = 0;
    uint32_t deltas = 0;  ///< first float of the targets
    bool operator==(const Job&) const = default;
  };
  void addRest(const Primitive& primitive, Rest& rest, std::vector<uint32_t>& skin,
               std::vector<float>& morph);

  gpu::Device& device_;
  std::map<std::pair<int, int>, Rest> rest_;
  gpu::Buffer skin_, morph_, jobBuffer_, jointBuffer_, weightBuffer_;
  std::vector<Job> jobs_, nextJobs_;
  std::vector<glm::mat4> joints_, nextJoints_;
  std::vector<float> weights_, nextWeights_;
  frame::BufferHandle jobHandle_, jointHandle_, weightHandle_;
};

}  // namespace limn::scene
