// @NAME@: percentage-closer filtering (Reeves et al. 1987), to be replaced by your own method.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter kParameters[] = {
    integer("taps", 4, {1, 64}, "texels", "Width and height of the filter").quality(),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "map of 16 texels", .settings = "shadow_map_size=16", .factor = 4},
};

class @CLASS@ : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    shadow::VisibilityPass pass = shadow::visibilityPass(inputs, request, info.name);
    pass.bind = [taps = inputs.parameters.integer("taps")](frame::PassContext&, gpu::Program& program) {
      program.set("taps", taps);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{.name = "@NAME@",
                                      .title = "@NAME@",
                                      .source = "Reeves, Salesin, Cook 1987",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(@CLASS@::info, @CLASS@)
