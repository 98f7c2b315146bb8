// Area lights as many point samples, each with a shadow map of its own (Brotman and Badler 1984; Haeberli and
// Akeley 1990): converges to the truth, and is what the soft-shadow techniques are compared with on the GPU.
#include <algorithm>
#include <cstdint>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/light_textures.h"
#include "core/shadow/sample_batches.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"
#include "glsl/numeric/sampling.glsl"

namespace {

using namespace limn;

constexpr Parameter kParameters[] = {
    integer("samples", 64, {1, 4096}, "samples", "Points on each light, and maps rendered from them")
        .quality()
        .logScale(),
    shadow::shadowMapSizeParameter(512),
    shadow::shadowMapFitParameter(1),
    shadow::biasParameter(),
    shadow::memoryParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "one sample", .settings = "samples=1", .factor = 8},
    {.name = "maps of 16 texels", .settings = "shadow_map_size=16", .factor = 8},
};

class SampledAreaLight : public Technique {
  using Batch = shadow::SampleBatch;

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    frame::TextureHandle target = request.target;
    for (const Batch& batch : batchesOf(inputs, request))
      target = request.term == Term::direct ? addDirect(graph, inputs, request, target, batch)
                                            : addVisibility(graph, inputs, target, request, batch);
    return target;
  }

  /// Maps of samples first .. first + count - 1.
  static shadow::ShadowMapDesc mapsOf(const ParameterValues& values, int first, int count) {
    shadow::ShadowMapDesc desc = shadow::shadowMapDesc(values);
    const auto total = static_cast<uint32_t>(values.integer("samples"));
    for (int i = first; i < first + count; ++i)
      desc.samples.push_back(glsl::r2_point(static_cast<uint32_t>(i), total));
    return desc;
  }

  static std::vector<Batch> batchesOf(const TechniqueInputs& inputs, const TermRequest& request) {
    const int samples = inputs.parameters.integer("samples");
    // Faces are chosen for all samples: those at a light's edge may need more than its centre does.
    const shadow::ShadowMapDesc all = mapsOf(inputs.parameters, 0, samples);
    const std::span<const uint32_t> lights = request.lights;
    shadow::SampleLayers layers{.size = all.size};
    const auto dark = [&](uint32_t light) { return inputs.pose.lights[light].emission == glm::vec3(0); };
    const bool allDark = std::ranges::all_of(lights, dark);
    for (const uint32_t light : lights) {
      // Beside others a light that emits nothing is here only to show what leaving it out is worth: the
      // picture must stay.
      if (dark(light) && !allDark) continue;
      const int taken = inputs.service<shadow::ShadowMapService>().layersOf(light, all);
      if (glsl::light_has_extent(inputs.pose.lights[light]))
        layers.each += taken / samples;
      else
        layers.shared += taken;
    }
    const int memory = inputs.parameters.integer("memory");
    if (request.term != Term::direct) return shadow::sampleBatches(samples, layers, memory);
    // A pixel goes through the samples of all lights, and their light through the medium.
    const int lightCount = std::max(1, static_cast<int>(lights.size()));
    return shadow::sampleBatches(samples, layers, memory,
                                 std::max(1, shadow::mostSamplesOfLoop(inputs) / lightCount));
  }

  static shadow::VisibilityPass commonPass(const TechniqueInputs& inputs, std::span<const uint32_t> lights,
                                           const Batch& batch) {
    shadow::ShadowMapDesc desc = mapsOf(inputs.parameters, batch.first, batch.count);
    desc.cacheable = batch.count == batch.total;
    desc.punctual = batch.isFirst();
    return {
        .name = "visibility",
        .technique = info.name,
        .program = {},
        .maps = inputs.service<shadow::ShadowMapService>().request(lights, desc),
        .bias = inputs.parameters.real("bias"),
        .bind = [batch](frame::PassContext&, gpu::Program& program) { shadow::setBatch(program, batch); }};
  }

  static frame::TextureHandle addVisibility(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                            frame::TextureHandle target, const TermRequest& request,
                                            const Batch& batch) {
    shadow::VisibilityPass pass = commonPass(inputs, request.lights, batch);
    pass.accumulate = !batch.isFirst();
    pass.program.files = {"techniques/sampled_area_light/visibility.comp.glsl"};
    batch.defineOrder(pass.program.defines);
    return shadow::addVisibilityPass(graph, inputs, target, std::move(pass));
  }

  static frame::TextureHandle addDirect(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                        const TermRequest& request, frame::TextureHandle target,
                                        const Batch& batch) {
    shadow::VisibilityPass pass = commonPass(inputs, request.lights, batch);
    pass.name = "direct";
    pass.image = "radiance";
    pass.reflects = true;
    pass.accumulate = true;
    pass.program = {.files = {"techniques/sampled_area_light/direct.comp.glsl"},
                    .defines = {{"MEDIUM", inputs.scene.medium.present() ? "1" : "0"}}};
    const scene::MediumInput medium(inputs.handles);
    medium.define(pass.program.defines);
    const scene::LightTextureInput textures(inputs.handles);
    textures.define(pass.program.defines);
    pass.declare = [medium, textures](frame::PassBuilder& builder) {
      medium.declare(builder);
      textures.declare(builder);
    };
    pass.bind = [bindSamples = pass.bind, lights = static_cast<int>(request.lights.size())](
                    frame::PassContext& context, gpu::Program& program) {
      bindSamples(context, program);
      program.set("light_count", lights);
    };
    return shadow::addVisibilityPass(graph, inputs, target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{.name = "sampled_area_light",
                                      .title = "Sampled area lights",
                                      .source = "Haeberli and Akeley 1990, The Accumulation Buffer",
                                      .terms = Term::visibility | Term::direct,
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(SampledAreaLight::info, SampledAreaLight)
