// Lines of light without a physical model: the baseline of chapter 8.
#include "core/caustics/ray_lines.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter kParameters[] = {
    caustics::bufferSizeParameter(),
    caustics::sceneMapSizeParameter(),
    caustics::pathsParameter(),
    caustics::lightSamplesParameter(),
    caustics::rayStepsParameter(),
    caustics::exitStepsParameter(),
    real("scale", 0.002, {0, 1e6}, "pixels/(sr m^2)",
         "Radiance that a fragment adds per watt of its line, in a picture of one pixel's height; set by "
         "hand for each scene"),
};
constexpr StressCase kStress[] = {
    {.name = "buffer of 1 texel", .settings = "buffer_size=1", .factor = 0},
    {.name = "one point of each search", .settings = "ray_steps=1 exit_steps=1", .factor = 0},
};

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
                       .beams = false,
                       .bind = [scale = p.real("scale") * static_cast<float>(inputs.size.y)](
                                   gpu::Program& program) { program.set("scale", scale); }});
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
