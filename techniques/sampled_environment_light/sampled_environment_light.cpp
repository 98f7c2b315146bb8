// The environment as many directions, each with a hard shadow map of its own: what its decomposition into
// area lights is compared with on the GPU.
#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/environment_light.h"
#include "core/shading_maps/shading_maps.h"
#include "core/shadow/environment_samples.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter kParameters[] = {
    integer("samples", 64, {1, 4096}, "samples", "Directions, and shadow maps rendered along them")
        .quality()
        .logScale(),
    shadow::shadowMapSizeParameter(512),
    shadow::shadowMapFitParameter(),
    shadow::biasParameter(),
    shadow::memoryParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "one sample", .settings = "samples=1", .factor = 8},
    {.name = "maps of 16 texels", .settings = "shadow_map_size=16", .factor = 8},
};

class SampledEnvironmentLight : public Technique {
  /// Of all requests: what enters translucent surfaces is asked for apart.
  shadow::EnvironmentSamples samples_;
  frame::BufferHandle samplesHandle_;

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const scene::EnvironmentLight& environment =
        inputs.service<shading_maps::ShadingMapService>().environmentLight();
    if (!environment.present()) {
      graph.leaveOut("environment", info.name, "the environment is black");
      return request.target;
    }
    if (!samplesHandle_) {
      samples_ = shadow::EnvironmentSamples(inputs.gpuScene.device(), environment,
                                            inputs.parameters.integer("samples"));
      samplesHandle_ = graph.importBuffer("samples of the environment", samples_.buffer());
    }
    return shadow::addSampledEnvironment(graph, inputs, info.name, samples_, samplesHandle_, request.target);
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "sampled_environment_light",
      .title = "Sampled environment light",
      .source = "the thesis, figures 5.10 and 5.11 (shadow maps of many samples)",
      .terms = termSet(Term::environment),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(SampledEnvironmentLight::info, SampledEnvironmentLight)
