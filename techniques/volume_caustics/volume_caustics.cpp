// Volume caustics: light that specular objects reflect or refract into the medium, as lines.
#include <array>

#include "core/caustics/ray_lines.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr auto kParameters = caustics::rayParameters(std::to_array<Parameter>({
    boolean("beams", true,
            "Lines whose beam is wider than a pixel become quads of that width; false: lines alone, as "
            "published"),
    caustics::beamCosineParameter(),
    integer("steps", 1, {1, 4}, "steps",
            "Regular points of the viewing ray that share a fragment's light; 1: its place on the light ray"),
    real("step", 0.02, {1e-4, 1}, "scene radii", "Distance between these points"),
    scene::mediumStepsParameter(),
    real("filter_radius", 1, {0.1, 8}, "steps", "Radius of the Gaussian by which they share"),
}));
/// Caustic lines are a part of what the medium scatters, and in the balls of other cases too small a part to
/// be missed.
constexpr const char* kScene = "glass_sphere";
constexpr const char* kRest = "airlight";
constexpr StressCase kStress[] = {
    {.name = "buffer of 1 texel", .scene = kScene, .settings = "buffer_size=1", .beside = kRest, .factor = 0},
    {.name = "buffer of 16 texels",
     .scene = kScene,
     .settings = "buffer_size=16",
     .beside = kRest,
     .factor = 6},
    {.name = "lines alone", .scene = kScene, .settings = "beams=false", .beside = kRest, .factor = 6},
    {.name = "no beam between rays",
     .scene = kScene,
     .settings = "beam_cosine=1",
     .beside = kRest,
     .factor = 6},
    {.name = "beams across edges",
     .scene = "gem",
     .settings = "beam_cosine=-1",
     .beside = kRest,
     .factor = 6},
    {.name = "one point of each search",
     .scene = kScene,
     .settings = "ray_steps=1 exit_steps=1",
     .beside = kRest,
     .factor = 0},
    {.name = "many points of each search",
     .scene = kScene,
     .settings = "ray_steps=4096 exit_steps=1024 buffer_size=64",
     .beside = kRest,
     .factor = 6},
    {.name = "reflection alone",
     .scene = kScene,
     .settings = "paths=reflection",
     .beside = kRest,
     .factor = 0},
    {.name = "four steps", .scene = kScene, .settings = "steps=4", .beside = kRest, .factor = 2},
};

class VolumeCaustics : public Technique {
  caustics::RayLines lines_;

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    const caustics::CausticRays rays =
        caustics::requestRays(graph, inputs, request, "caustic lines", info.name);
    if (!rays.rays) return request.target;
    const int steps = p.integer("steps");
    return lines_.add(
        graph, inputs, rays, request.target,
        {.technique = info.name,
         .fragmentShader = "techniques/volume_caustics/line.frag.glsl",
         .defines = {{"STEPS", std::to_string(steps)}},
         .mediumSteps = p.integer("medium_steps"),
         .beams = p.boolean("beams"),
         .beamCosine = p.real("beam_cosine"),
         .bind = [steps, step = p.real("step"), radius = p.real("filter_radius")](gpu::Program& program) {
           if (steps == 1) return;
           program.set("step_size", step);
           program.set("filter_radius", radius);
         }});
  }

 public:
  static constexpr TechniqueInfo info{.name = "volume_caustics",
                                      .title = "Volume caustics",
                                      .source = "Hu et al. 2010; thesis, chapter 8",
                                      .terms = termSet(Term::media),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(VolumeCaustics::info, VolumeCaustics)
