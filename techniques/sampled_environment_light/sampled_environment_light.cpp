// The environment as many directions, each with a hard shadow map of its own: what its decomposition into
// area lights is compared with on the GPU.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/environment_light.h"
#include "core/shadow/sample_batches.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"
#include "glsl/materials/material_model.glsl"

namespace {

using namespace limn;
using frame::Access;

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
  std::vector<glm::vec3> directions_;  ///< of propagation
  gpu::Buffer irradiance_;             ///< of each sample on a surface that faces it, were it all: vec4
  gpu::Texture map_;                   ///< for coats alone

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const scene::EnvironmentLight environment(inputs.scene.environment);
    if (!environment.present()) {
      graph.leaveOut("environment", info.name, "the environment is black");
      return request.target;
    }
    takeSamples(environment, inputs);
    Inputs samples = importInputs(graph, inputs);
    frame::TextureHandle target = request.target;
    for (const shadow::SampleBatch& batch :
         shadow::sampleBatches(inputs.parameters.integer("samples"),
                               {.each = 1, .size = inputs.parameters.integer("shadow_map_size")},
                               inputs.parameters.integer("memory")))
      target = addBatch(graph, inputs, target, samples, batch);
    return target;
  }

  /// Directions by the map's own density, so that all samples are about equally bright.
  void takeSamples(const scene::EnvironmentLight& environment, const TechniqueInputs& inputs) {
    const int count = inputs.parameters.integer("samples");
    std::vector<glm::vec4> irradiance;
    directions_.clear();
    for (int i = 0; i < count; ++i) {
      const glm::vec3 towards = environment.sample(shadow::samplePlace(i));
      const float density = environment.pdf(towards);
      directions_.push_back(-glm::normalize(towards));
      irradiance.emplace_back(density > 0 ? environment.radiance(towards) / density : glm::vec3(0), 0);
    }
    irradiance_ =
        gpu::Buffer::of<glm::vec4>(inputs.gpuScene.device(), "irradiance of the samples", irradiance);
  }

  /// What batches read, and what they hand on to the next; the latter two are empty without coats, which
  /// mirror the map.
  struct Inputs {
    frame::BufferHandle irradiance;
    frame::TextureHandle map;
    frame::TextureHandle mirrorSums;  ///< also empty before the first batch
  };
  Inputs importInputs(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
    Inputs result{graph.importBuffer("irradiance of the samples", irradiance_), {}, {}};
    if ((inputs.handles.modelKinds & 1u << glsl::model_coated) == 0) return result;
    const scene::Environment& e = inputs.scene.environment;
    map_ = gpu::Texture(inputs.gpuScene.device(), "environment",
                        {.format = GL_RGB32F, .width = e.width, .height = e.height});
    map_.setSampling(GL_LINEAR, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE);
    map_.upload(0, 0, GL_RGB, GL_FLOAT, e.texels.data());
    result.map = graph.importTexture("environment", map_);
    return result;
  }

  frame::TextureHandle addBatch(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                frame::TextureHandle target, Inputs& samples,
                                const shadow::SampleBatch& batch) {
    const std::span<const glm::vec3> directions =
        std::span(directions_).subspan(static_cast<size_t>(batch.first), static_cast<size_t>(batch.count));
    shadow::ShadowMapDesc desc = shadow::shadowMapDesc(inputs.parameters);
    desc.cacheable = batch.count == batch.total;
    const bool first = batch.first == 0, last = batch.first + batch.count == batch.total;
    if (samples.map && first && !last)
      samples.mirrorSums = graph.createTexture(
          "mirrored samples", {.format = GL_RG32F, .width = inputs.size.x, .height = inputs.size.y});
    std::map<std::string, std::string> defines;
    if (samples.map) defines = {{"MIRROR_FIRST", first ? "1" : "0"}, {"MIRROR_LAST", last ? "1" : "0"}};
    shadow::VisibilityPass pass{
        .name = "environment",
        .technique = info.name,
        .program = {.files = {"techniques/sampled_environment_light/environment.comp.glsl"},
                    .defines = std::move(defines)},
        .image = "radiance",
        .maps = inputs.service<shadow::ShadowMapService>().request(directions, desc),
        .bias = inputs.parameters.real("bias"),
        .lightSize = std::nullopt,
        .reflects = true,
        .bind = [batch](frame::PassContext&, gpu::Program& program) { shadow::setBatch(program, batch); },
        .declare =
            [&samples, first, last](frame::PassBuilder& builder) {
              builder.read(samples.irradiance, Access::storageLoad, "Irradiance",
                           "what each direction brings");
              if (!samples.map) return;
              if (last) builder.read(samples.map, Access::sampled, "environment_map", "what coats mirror");
              if (!samples.mirrorSums) return;
              constexpr const char* why = "how much of a mirror's surroundings is seen";
              if (last)
                builder.read(samples.mirrorSums, Access::imageLoad, "mirror_sums", why);
              else
                samples.mirrorSums =
                    builder.write(samples.mirrorSums, first ? Access::imageStore : Access::imageLoadStore,
                                  "mirror_sums", why);
            },
        .accumulate = true};
    return shadow::addVisibilityPass(graph, inputs, target, std::move(pass));
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
