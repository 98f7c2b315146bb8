// Soft shadow mapping by backprojection (Guennebaud, Barthe and Paulin 2006).
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter kParameters[] = {
    integer(
        "patches", 32, {2, 1024}, "micro-patches",
        "Micro-patches along each side of a kernel, at most; wider kernels are walked in steps of several "
        "texels")
        .quality()
        .logScale(),
    integer("search_rounds", 8, {0, 16}, "rounds",
            "How often the kernel is narrowed by the min-max pyramid, at most; 0: at the near plane")
        .quality(),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(),
    shadow::viewsParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
};

class Backprojection : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    shadow::VisibilityPass pass = shadow::visibilityPass(inputs, request, info.name);
    pass.sampled = {{"shadow_min_max",
                     inputs.service<shadow::ShadowMapService>().minMaxPyramid(pass.maps).texture,
                     "nearest and farthest depths"}};
    pass.bind = [patches = p.integer("patches"), rounds = p.integer("search_rounds")](frame::PassContext&,
                                                                                      gpu::Program& program) {
      program.set("patches", patches);
      program.set("search_rounds", rounds);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
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
