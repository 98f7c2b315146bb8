// Area lights as many point samples, each with a shadow map of its own (Brotman and Badler 1984; Haeberli and
// Akeley 1990): converges to the truth, and is what the soft-shadow techniques are compared with on the GPU.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"
#include "glsl/gbuffer.glsl"
#include "glsl/sampling.glsl"

namespace {

using namespace limn;
using frame::Access;

constexpr Parameter parameters[] = {
    integer("samples", 64, {1, 4096}, "samples", "Points on each light, and maps rendered from them")
        .quality()
        .logScale(),
    shadow::shadowMapSizeParameter(512),
    shadow::biasParameter(),
    integer("memory", 256, {1, 4096}, "MiB",
            "Shadow maps held at once; more samples are rendered in batches"),
};

class SampledAreaLight : public Technique {
  struct Batch {
    int first = 0, count = 0, total = 0;
  };

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const int total = inputs.parameters.integer("samples");
    const int inBatch = std::min(total, samplesPerBatch(inputs, request.lights));
    frame::TextureHandle target = request.target;
    for (Batch batch{0, inBatch, total}; batch.first < total; batch.first += inBatch) {
      batch.count = std::min(inBatch, total - batch.first);
      target = request.term == Term::direct ? addDirect(graph, inputs, request, target, batch)
                                            : addVisibility(graph, inputs, target, request, batch);
    }
    return target;
  }

  static int samplesPerBatch(const TechniqueInputs& inputs, std::span<const uint32_t> lights) {
    const int size = inputs.parameters.integer("shadow_map_size");
    int64_t layers = 0;
    for (const uint32_t light : lights) layers += inputs.shadowMaps.layersOf(light, {.size = size});
    constexpr int64_t bytesPerTexel = 8;  // rasterised and linear depth
    const int64_t bytes = std::max<int64_t>(layers, 1) * size * size * bytesPerTexel;
    const int64_t fit = (int64_t{inputs.parameters.integer("memory")} << 20) / bytes;
    constexpr int64_t mostLayers = 2048;  // every device has as many
    return static_cast<int>(
        std::clamp<int64_t>(std::min(fit, mostLayers / std::max<int64_t>(layers, 1)), 1, 4096));
  }

  static shadow::VisibilityPass commonPass(const TechniqueInputs& inputs, std::span<const uint32_t> lights,
                                           const Batch& batch) {
    shadow::ShadowMapDesc desc{.size = inputs.parameters.integer("shadow_map_size"),
                               .cacheable = batch.count == batch.total};
    for (int i = batch.first; i < batch.first + batch.count; ++i)
      desc.samples.push_back(glm::fract(glsl::r2_sequence(static_cast<uint32_t>(i)) + 0.5f));
    return {.name = "visibility",
            .technique = info.name,
            .program = {},
            .maps = inputs.shadowMaps.request(lights, desc),
            .bias = inputs.parameters.real("bias"),
            .bind = [batch](frame::PassContext&, gpu::Program& program) {
              program.set("first_sample", batch.first);
              program.set("batch_samples", batch.count);
              program.set("total_samples", batch.total);
            }};
  }

  static frame::TextureHandle addVisibility(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                            frame::TextureHandle target, const TermRequest& request,
                                            const Batch& batch) {
    shadow::VisibilityPass pass = commonPass(inputs, request.lights, batch);
    pass.accumulate = batch.first > 0;
    pass.program = {.files = {"techniques/sampled_area_light/visibility.comp.glsl"},
                    .defines = {{"ACCUMULATE", pass.accumulate ? "1" : "0"}}};
    return shadow::addVisibilityPass(graph, inputs, target, std::move(pass));
  }

  static frame::TextureHandle addDirect(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                        const TermRequest& request, frame::TextureHandle target,
                                        const Batch& batch) {
    shadow::VisibilityPass pass = commonPass(inputs, request.lights, batch);
    pass.name = "direct";
    pass.accumulate = true;
    pass.program = {.files = {"techniques/sampled_area_light/direct.comp.glsl"}, .defines = {}};
    const GBuffer& g = inputs.gbuffer;
    pass.declare = [&g](frame::PassBuilder& builder) {
      builder.read(g.normal, Access::sampled, "shading normals")
          .read(g.albedo, Access::sampled, "base colour, metallic")
          .read(g.material, Access::sampled, "roughness, specular")
          .read(g.emission, Access::sampled, "specular colour");
    };
    pass.bind = [bindSamples = pass.bind, g, lights = static_cast<int>(request.lights.size())](
                    frame::PassContext& context, gpu::Program& program) {
      bindSamples(context, program);
      program.set("light_count", lights);
      context.bindSampled(glsl::gbuffer_unit_normal, g.normal);
      context.bindSampled(glsl::gbuffer_unit_albedo, g.albedo);
      context.bindSampled(glsl::gbuffer_unit_material, g.material);
      context.bindSampled(glsl::gbuffer_unit_emission, g.emission);
    };
    return shadow::addVisibilityPass(graph, inputs, target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{.name = "sampled_area_light",
                                      .title = "Sampled area lights",
                                      .source = "Haeberli and Akeley 1990, The Accumulation Buffer",
                                      .terms = Term::visibility | Term::direct,
                                      .parameters = parameters};
};

}  // namespace

LIMN_TECHNIQUE(SampledAreaLight::info, SampledAreaLight)
