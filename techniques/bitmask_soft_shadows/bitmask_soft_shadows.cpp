// Bitmask soft shadows (Schwarz and Stamminger 2007).
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kSampleCounts[] = {"64", "128", "256"};
constexpr Parameter kParameters[] = {
    choice("sample_points", 0, kSampleCounts, "Sample points on the light, one bit each").quality(),
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
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
};

class BitmaskSoftShadows : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    shadow::VisibilityPass pass = shadow::visibilityPass(
        inputs, request, info.name, {{"WORDS", std::to_string(2 << p.choice("sample_points"))}});
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
  static constexpr TechniqueInfo info{.name = "bitmask_soft_shadows",
                                      .title = "Bitmask soft shadows",
                                      .source = "Schwarz and Stamminger 2007, Bitmask Soft Shadows",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(BitmaskSoftShadows::info, BitmaskSoftShadows)
