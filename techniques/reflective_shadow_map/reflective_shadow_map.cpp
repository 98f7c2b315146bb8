// Reflective shadow maps (Dachsbacher and Stamminger 2005): one bounce from virtual point lights that nothing
// occludes.
#include "core/indirect/gather.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr auto kParameters = indirect::gatherParameters();
constexpr StressCase kStress[] = {
    {.name = "one virtual light", .scene = "cornell_box", .settings = "vpls=1", .factor = 4},
    {.name = "N not divisible", .scene = "cornell_box", .settings = "vpls=1021"},
    {.name = "no bound, no blur", .scene = "cornell_box", .settings = "clamp=0 blur=false", .factor = 20},
    {.name = "map of 16 texels", .scene = "cornell_box", .settings = "rsm_size=16", .factor = 2},
};

class ReflectiveShadowMap : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const auto lights = indirect::virtualLightsOf(graph, inputs, request, info.name);
    if (!lights) return request.target;
    indirect::Gather gather(graph, inputs, info.name, *lights, indirect::gatherSettings(inputs.parameters));
    gather.shade({.program = {.files = {"techniques/reflective_shadow_map/shade.comp.glsl"}, .defines = {}}});
    return gather.finish(request.target);
  }

 public:
  static constexpr TechniqueInfo info{.name = "reflective_shadow_map",
                                      .title = "Reflective shadow maps",
                                      .source = "Dachsbacher and Stamminger 2005, Reflective Shadow Maps",
                                      .terms = termSet(Term::indirect),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(ReflectiveShadowMap::info, ReflectiveShadowMap)
