// Declares samples of the environment's light: directions, each with a hard shadow map of its own, that
// surfaces reflect with their whole BRDF.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu/objects.h"
#include "core/scene/environment_light.h"
#include "core/shadow/sample_batches.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"
#include "glsl/light/environment_sample.glsl"

namespace limn::shadow {

/// Holds samples and their buffer; it lives as long as the graph that its passes are declared in.
class LIMN_API EnvironmentSamples {
 public:
  EnvironmentSamples() = default;
  /// Takes the first `count` points of the R2 sequence through the environment's own density, so that all
  /// samples are about equally bright; fewer are a prefix of more. `environment` must be present.
  EnvironmentSamples(gpu::Device& device, const scene::EnvironmentLight& environment, int count);
  /// Takes the regions that the environment is decomposed into at that threshold
  /// (shading::decomposeEnvironment), brightest first: a sample in the middle of each, with all of its light.
  EnvironmentSamples(gpu::Device& device, const scene::Environment& environment, double threshold);

  int count() const { return static_cast<int>(directions_.size()); }
  /// Returns the directions in which light travels.
  std::span<const glm::vec3> directions() const { return directions_; }
  /// Returns the buffer of the samples, "EnvironmentSamples" in glsl/shadow/environment_samples.glsl.
  const gpu::Buffer& buffer() const { return buffer_; }

 private:
  void add(const glm::vec3& towards, const glm::vec3& irradiance);
  void upload(gpu::Device& device);

  std::vector<glm::vec3> directions_;
  std::vector<glsl::EnvironmentSample> samples_;
  gpu::Buffer buffer_;
};

/// Returns the batches in which the maps of all samples are rendered, each for one loop of a program, for a
/// technique that declares shadow_map_size and memory.
LIMN_API std::vector<SampleBatch> sampleBatches(const EnvironmentSamples& samples,
                                                const TechniqueInputs& inputs);

/// Returns the pass over a batch of samples and their maps whose program, `file`, includes
/// glsl/shadow/environment_samples.glsl, for a technique that declares shadow_map_size, shadow_map_fit, bias
/// and memory. It names the samples as `handle`, a buffer imported from EnvironmentSamples::buffer().
LIMN_API VisibilityPass environmentSamplePass(const TechniqueInputs& inputs, std::string_view technique,
                                              const EnvironmentSamples& samples, frame::BufferHandle handle,
                                              const SampleBatch& batch, std::string file);

/// Adds the light of the samples that each pixel sees to the radiance `target`: the estimate that converges
/// to the environment's direct light. Returns the target after it. `handle`: as above.
LIMN_API frame::TextureHandle addSampledEnvironment(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                    std::string_view technique,
                                                    const EnvironmentSamples& samples,
                                                    frame::BufferHandle handle, frame::TextureHandle target);

}  // namespace limn::shadow
