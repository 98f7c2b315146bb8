// Shadow mapping (Williams 1978): one depth comparison per pixel and light.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kFilters[] = {"nearest", "2x2"};
constexpr Parameter kParameters[] = {
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(),
    shadow::biasParameter(),
    choice("filter", 0, kFilters, "One texel, or the four around the receiver weighted bilinearly"),
};
constexpr StressCase kStress[] = {
    {.name = "map of 16 texels", .settings = "shadow_map_size=16", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
    {.name = "no bias", .settings = "bias=0", .factor = 4},
};

class HardShadowMap : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const char* filter = inputs.parameters.choice("filter") == 0 ? "0" : "1";
    return shadow::addVisibilityPass(
        graph, inputs, request.target,
        shadow::visibilityPass(inputs, request, info.name, {{"FILTER", filter}}));
  }

 public:
  static constexpr TechniqueInfo info{.name = "hard_shadow_map",
                                      .title = "Hard shadow mapping",
                                      .source = "Williams 1978, Casting Curved Shadows on Curved Surfaces",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(HardShadowMap::info, HardShadowMap)
