// Airlight: what the medium scatters of the lights' direct light, with its shadows.
#include <algorithm>
#include <vector>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/light_textures.h"
#include "core/shadow/alike_lights.h"
#include "core/shadow/sample_batches.h"
#include "core/shadow/shadow_map.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;
using frame::Access;

constexpr Parameter kParameters[] = {
    shadow::shadowMapSizeParameter(),
    integer("steps", 48, {1, 1024}, "steps",
            "Stretches of each viewing ray, even in the angle from the light")
        .quality()
        .logScale(),
    scene::mediumStepsParameter(),
    integer("light_samples", 1, {1, 64}, "points",
            "Points on each light with extent, each with its own maps; 1: its centre")
        .quality(),
};
constexpr StressCase kStress[] = {
    {.name = "one stretch", .settings = "steps=1", .factor = 20},
    {.name = "a third of the stretches", .settings = "steps=16", .factor = 2},
    {.name = "map of 16 texels", .settings = "shadow_map_size=16", .factor = 20},
};

/// Holds what a pass adds: of the maps of its lights, and of the stretches of each ray, the first one and the
/// one after the last.
struct Part {
  int firstMap, endMap, firstStretch, endStretch;
};

/// Returns the passes for `maps` maps, whose loops take at most `most` steps together (mostStepsOfLoops):
/// one, but for software renderers. `way`: steps at most that a way through a grid takes; 0: there is none.
std::vector<Part> partsOf(int most, int maps, int steps, int way) {
  // Eight rays are followed at once, and may wait for each other at all of their borders of shadows. Each
  // stretch is a step of both loops over stretches, may have 6 refinements, and has two nodes.
  const int ofStretch = 8 * (8 + 2 * way);
  // Each map is a step, and has the way to the eye and the stretches before the part.
  const int ofMap = 1 + way + (way > 0 ? steps : 0);
  const int stretches = std::clamp((most - ofMap) / ofStretch, 1, steps);
  const int together = stretches < steps ? 1 : std::max(most / (ofMap + steps * ofStretch), 1);
  std::vector<Part> parts;
  for (int map = 0; map < maps; map += together)
    for (int stretch = 0; stretch < steps; stretch += stretches)
      parts.push_back({map, std::min(map + together, maps), stretch, std::min(stretch + stretches, steps)});
  return parts;
}

class Airlight : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const std::span<const uint32_t> lights = request.lights;
    const char* dark = nullptr;
    if (inputs.scene.medium.sigmaS == glm::vec3(0)) dark = "no medium scatters light";
    if (inputs.scene.environment && !dark && std::ranges::none_of(lights, [&](uint32_t light) {
          return (inputs.pose.lights[light].flags & glsl::light_flag_environment) != 0;
        }))
      graph.leaveOut(
          "airlight of the environment", info.name,
          request.chosen ? "another light was chosen" : "no lights stand for it (--environment-lights)");
    if (lights.empty()) dark = "the scene has no light";
    if (dark) {
      graph.leaveOut("airlight", info.name, dark);
      return request.target;
    }
    const ParameterValues& p = inputs.parameters;
    const int samples = p.integer("light_samples");
    const shadow::ShadowMapDesc desc{.size = p.integer("shadow_map_size"),
                                     .samples = shadow::pointsOnLights(samples)};
    const shadow::ShadowMaps maps = inputs.service<shadow::ShadowMapService>().request(lights, desc);
    frame::TextureHandle target = request.target;
    // Of the loops in medium_length(): its points, and the axes of the grid's box.
    const int way = inputs.handles.density ? 2 * p.integer("medium_steps") + 3 : 0;
    for (const shadow::AlikeLights& alike :
         shadow::alikeLights(inputs.service<shadow::ShadowMapService>().layouts(maps)))
      for (const Part& part :
           partsOf(shadow::mostStepsOfLoops(inputs), static_cast<int>(alike.layers.size()) * samples,
                   p.integer("steps"), way))
        target = addPass(graph, inputs, maps, alike, part, target);
    return target;
  }

  /// Adds a part of the light of lights that are alike to `target`, and returns it after that.
  static frame::TextureHandle addPass(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                      const shadow::ShadowMaps& maps, const shadow::AlikeLights& lights,
                                      const Part& part, frame::TextureHandle target) {
    const ParameterValues& p = inputs.parameters;
    frame::PassBuilder pass = graph.addPass("airlight", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, medium")
        .read(inputs.handles.lights, Access::storageLoad, "Lights", "what lights send")
        .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "where viewing rays end");
    gpu::ProgramDesc source{.files = {"techniques/airlight/airlight.comp.glsl"}, .defines = {}};
    shadow::readMaps(pass, inputs.gpuScene.device(), maps, source.defines);
    lights.define(source.defines);
    const frame::TextureHandle result =
        pass.write(target, Access::imageLoadStore, "radiance", "light scattered towards the camera");
    const scene::MediumInput medium(inputs.handles, p.integer("medium_steps"));
    medium.define(source.defines);
    medium.declare(pass);
    const scene::LightTextureInput textures(inputs.handles);
    textures.define(source.defines);
    textures.declare(pass);
    const auto program = pass.program(std::move(source));
    pass.execute([program, lights, part, samples = p.integer("light_samples"), size = inputs.size,
                  steps = p.integer("steps")](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      kernel.set("light_samples", samples);
      kernel.set("steps", steps);
      kernel.set("first_map", part.firstMap);
      kernel.set("end_map", part.endMap);
      kernel.set("first_stretch", part.firstStretch);
      kernel.set("end_stretch", part.endStretch);
      lights.bind(kernel);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "airlight",
      .title = "Airlight with volumetric shadows",
      .source = "Sun et al. 2005; Wyman and Ramsey 2008; thesis, section 8.3.1",
      .terms = termSet(Term::media),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(Airlight::info, Airlight)
