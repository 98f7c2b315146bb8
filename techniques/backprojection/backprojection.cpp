// Soft shadow mapping by backprojection (Guennebaud, Barthe and Paulin 2006).
#include "core/shadow/micro_patches.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter kParameters[] = {
    shadow::patchesParameter(),       shadow::patchSearchRoundsParameter(),
    shadow::shadowMapSizeParameter(), shadow::shadowMapFitParameter(),
    shadow::viewsParameter(),         shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
};

class Backprojection : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    return shadow::addVisibilityPass(graph, inputs, request.target,
                                     shadow::microPatchPass(inputs, request, info.name));
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "backprojection",
      .title = "Soft shadow mapping by backprojection",
      .source = "Guennebaud, Barthe and Paulin 2006, Real-time Soft Shadow Mapping by Backprojection",
      .terms = termSet(Term::visibility),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(Backprojection::info, Backprojection)
