#include "core/shadow/environment_samples.h"

#include <utility>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/scene.h"
#include "core/shading/environment_decomposition.h"
#include "core/shading_maps/shading_maps.h"
#include "glsl/materials/material_model.glsl"
#include "glsl/numeric/equirectangular.glsl"

namespace limn::shadow {

using frame::Access;
using frame::TextureHandle;

EnvironmentSamples::EnvironmentSamples(gpu::Device& device, const scene::EnvironmentLight& environment,
                                       int count) {
  for (int i = 0; i < count; ++i) {
    const glm::vec3 towards = environment.sample(samplePlace(i));
    const float density = environment.pdf(towards);
    add(glm::normalize(towards), density > 0 ? environment.radiance(towards) / density : glm::vec3(0));
  }
  upload(device);
}

EnvironmentSamples::EnvironmentSamples(gpu::Device& device, const scene::Environment& environment,
                                       double threshold) {
  const auto lights = shading::decomposeEnvironment(environment, {.threshold = threshold}).lights;
  for (const scene::DistantRectangle& light : lights)
    add(glsl::environment_world_direction(glm::normalize(light.centre), environment.rotation),
        environment.scale * static_cast<float>(lights.size()) * light.irradiance);
  upload(device);
}

void EnvironmentSamples::add(const glm::vec3& towards, const glm::vec3& irradiance) {
  directions_.push_back(-towards);
  samples_.push_back({irradiance, 0, towards, 0});
}

void EnvironmentSamples::upload(gpu::Device& device) {
  buffer_ = gpu::Buffer::of<glsl::EnvironmentSample>(device, "samples of the environment", samples_);
}

std::vector<SampleBatch> sampleBatches(const EnvironmentSamples& samples, const TechniqueInputs& inputs) {
  return sampleBatches(samples.count(), {.each = 1, .size = inputs.parameters.integer("shadow_map_size")},
                       inputs.parameters.integer("memory"), mostSamplesOfLoop(inputs));
}

VisibilityPass environmentSamplePass(const TechniqueInputs& inputs, std::string_view technique,
                                     const EnvironmentSamples& samples, frame::BufferHandle handle,
                                     const SampleBatch& batch, std::string file) {
  ShadowMapDesc desc = shadowMapDesc(inputs.parameters);
  desc.cacheable = batch.count == batch.total;
  const std::span<const glm::vec3> directions =
      samples.directions().subspan(static_cast<size_t>(batch.first), static_cast<size_t>(batch.count));
  const scene::MediumInput medium(inputs.handles);
  VisibilityPass pass{
      .name = "environment",
      .technique = technique,
      .program = {.files = {std::move(file)},
                  .defines = {{"MEDIUM", inputs.scene.medium.present() ? "1" : "0"}}},
      .maps = inputs.service<ShadowMapService>().request(directions, desc),
      .bias = inputs.parameters.real("bias"),
      .lightSize = std::nullopt,
      .reflects = true,
      .bind = [batch](frame::PassContext&, gpu::Program& program) { setBatch(program, batch); },
      .declare =
          [handle, medium](frame::PassBuilder& builder) {
            builder.read(handle, Access::storageLoad, "EnvironmentSamples", "what each direction brings");
            medium.declare(builder);
          }};
  medium.define(pass.program.defines);
  return pass;
}

TextureHandle addSampledEnvironment(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                    std::string_view technique, const EnvironmentSamples& samples,
                                    frame::BufferHandle handle, TextureHandle target) {
  const bool coats = (inputs.handles.modelKinds & 1u << glsl::model_coated) != 0;
  TextureHandle mirrorSums;  // what a batch hands on to the next
  for (const SampleBatch& batch : sampleBatches(samples, inputs)) {
    VisibilityPass pass = environmentSamplePass(inputs, technique, samples, handle, batch,
                                                "glsl/shadow/sampled_environment.comp.glsl");
    pass.image = "radiance";
    pass.accumulate = true;
    if (coats) {
      batch.defineOrder(pass.program.defines);
      pass.declare = [&, declare = std::move(pass.declare)](frame::PassBuilder& builder) {
        declare(builder);
        const bool first = batch.isFirst(), last = batch.isLast();
        if (last)
          builder.read(inputs.service<shading_maps::ShadingMapService>().radiance(), Access::sampled,
                       "environment_map", "what coats mirror");
        if (first && last) return;
        constexpr const char* why = "how much of a mirror's surroundings is seen";
        if (first)
          mirrorSums = graph.createTexture(
              "mirrored samples", {.format = GL_RG32F, .width = inputs.size.x, .height = inputs.size.y});
        if (last)
          builder.read(mirrorSums, Access::imageLoad, "mirror_sums", why);
        else
          mirrorSums = builder.write(mirrorSums, first ? Access::imageStore : Access::imageLoadStore,
                                     "mirror_sums", why);
      };
    }
    target = addVisibilityPass(graph, inputs, target, std::move(pass));
  }
  return target;
}

}  // namespace limn::shadow
