// Declares the solution on the processor as passes: elements, the light of lights, bounces, and what of them
// goes up to the GPU.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/radiosity/light_samples.h"
#include "core/radiosity/sample_solver.h"
#include "core/radiosity/scene_elements.h"
#include "core/technique/technique.h"

namespace limn::illumination_samples {

/// Says what the specular part of a picture is made of.
enum class Shown {
  pixels,    ///< trees of leaves, looked up at each pixel
  vertices,  ///< the same, looked up at each leaf
  gathered,  ///< samples, reflected at each pixel
};

struct SolutionSettings {
  radiosity::SampleSettings samples;
  radiosity::TreeSettings shownTree;  ///< of leaves, for the viewer
  Shown shown = Shown::pixels;
  bool drawTree = false;  ///< that of the leaf in the middle of the picture, in a corner
  int bounces = 1;
  int lightRays = 16;         ///< to each extended light
  float longestEdge = 0.03f;  ///< radii of the scene
  std::string_view technique;
};

/// Declares the surface elements of a pose, and the pass that brings them there. The object must outlive the
/// graph.
class Elements {
 public:
  /// Throws UsageError for scenes of more elements than the memory allowed holds.
  Elements(frame::FrameGraph& graph, const TechniqueInputs& inputs, const SolutionSettings& settings);

  bool fits(const scene::Pose& pose) const { return elements_.fits(pose); }
  const radiosity::SceneElements& elements() const { return elements_; }
  const radiosity::Occlusion& occlusion() const { return *occlusion_; }

  frame::BufferHandle leaves, corners, parents;

 private:
  const scene::Scene& scene_;
  const scene::Pose& pose_;
  radiosity::SceneElements elements_;
  std::unique_ptr<radiosity::Occlusion> occlusion_;
  gpu::Buffer leafBuffer_, cornerBuffer_, parentBuffer_;
};

/// Declares the light that some lights send over surfaces. The object must outlive the graph.
class Solution {
 public:
  /// Declares the passes "light samples" and "shoot", a pass for each bounce, and those that make what is
  /// shown.
  Solution(frame::FrameGraph& graph, const TechniqueInputs& inputs, const Elements& elements,
           std::span<const uint32_t> lights, const SolutionSettings& settings);

  const std::vector<uint32_t>& lights() const { return lights_; }

  frame::BufferHandle irradiance;  ///< of leaf slots, W/m^2
  frame::BufferHandle ranges;      ///< of slots: the first sample, and how many; gathered
  frame::BufferHandle samples;     ///< of glsl::IlluminationSample; gathered
  frame::BufferHandle senders;     ///< of slots: glsl::SampleSender, world; gathered
  frame::BufferHandle trees;       ///< of leaf slots: where their nodes begin, and their scale; else
  frame::BufferHandle nodes;       ///< of all trees, as glsl/indirect/packed_tree.glsl has them

 private:
  struct LeafTree {
    uint32_t first = glsl::no_link;
    float scale = 0;
  };
  void addLights(frame::FrameGraph& graph, const TechniqueInputs& inputs);
  void addBounce(frame::FrameGraph& graph, gpu::Device& device);
  void addSamples(frame::FrameGraph& graph, const TechniqueInputs& inputs);
  void addTrees(frame::FrameGraph& graph, gpu::Device& device);
  void light(const scene::Pose& pose);
  void uploadSamples(gpu::Device& device, int mostSteps);
  void uploadTrees(gpu::Device& device);

  const Elements& elements_;
  SolutionSettings settings_;
  std::vector<uint32_t> lights_;
  radiosity::SampleSolver solver_;
  frame::BufferHandle lit_;
  gpu::Buffer litBuffer_, rangeBuffer_, sampleBuffer_, senderBuffer_, treeBuffer_, nodeBuffer_;
  std::deque<gpu::Buffer> irradianceBuffers_;  ///< the graph keeps their addresses
  std::vector<glm::vec4> irradianceNow_;
  std::vector<glm::uvec2> rangesNow_;
  std::vector<glsl::IlluminationSample> samplesNow_;
  std::vector<glsl::SampleSender> sendersNow_;
  std::vector<LeafTree> treesNow_;
  std::vector<glm::uvec2> nodesNow_;
};

}  // namespace limn::illumination_samples
