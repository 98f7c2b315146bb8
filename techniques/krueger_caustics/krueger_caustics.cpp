// Lines of light without a physical model: the baseline of chapter 8.
#include <algorithm>
#include <array>

#include "core/caustics/ray_lines.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr auto kParameters = caustics::rayParameters(std::to_array<Parameter>({
    boolean("attenuation", true,
            "The medium takes light along the lines and on the way to the eye, as the thesis adds it; false: "
            "as published"),
    scene::mediumStepsParameter(),
    real("scale", 1, {0, 1e6}, "",
         "Factor on the brightness of lines, which is derived for lines in all directions at the distance of "
         "the specular objects"),
}));
constexpr StressCase kStress[] = {
    {.name = "buffer of 1 texel", .settings = "buffer_size=1", .factor = 0},
    // Lines are a part of what the medium scatters. Their weight errs by far more than fewer of them do.
    {.name = "buffer of 64 texels",
     .scene = "glass_sphere",
     .settings = "buffer_size=64",
     .beside = "airlight"},
    {.name = "one point of each search", .settings = "ray_steps=1 exit_steps=1", .factor = 0},
};

/// Returns how far the middle of the specular objects is from the camera, in metres; at least their radius.
float objectsDistance(const scene::GpuScene& scene) {
  const scene::Bounds objects = scene.specularBounds();
  const glm::vec3 eye(scene.frame().camera_position);
  return std::max(glm::length(objects.centre() - eye), objects.radius());
}

class KruegerCaustics : public Technique {
  caustics::RayLines lines_;

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    const caustics::CausticRays rays =
        caustics::requestRays(graph, inputs, request, "caustic lines", info.name);
    if (!rays.rays) return request.target;
    return lines_.add(graph, inputs, rays, request.target,
                      {.technique = info.name,
                       .fragmentShader = "techniques/krueger_caustics/line.frag.glsl",
                       .defines = {{"ATTENUATION", p.boolean("attenuation") ? "1" : "0"}},
                       .mediumSteps = p.integer("medium_steps"),
                       .beams = false,
                       .bind = [&scene = inputs.gpuScene, scale = p.real("scale")](gpu::Program& program) {
                         program.set("objects_distance", objectsDistance(scene));
                         program.set("scale", scale);
                       }});
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "krueger_caustics",
      .title = "Caustic lines without a physical model",
      .source = "Krueger, Buerger and Westermann 2006, Interactive Screen-Space Accurate Photon Tracing",
      .terms = termSet(Term::media),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(KruegerCaustics::info, KruegerCaustics)
