// Moment soft shadow maps (Peters and Klein 2015, Peters et al. 2017): percentage-closer soft shadows of
// which both steps are prefiltered from four power moments of depth.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter parameters[] = {
    real("moment_bias", 1e-6, {1e-7, 0.1}, "",
         "Share by which moments are pulled towards those of a well-spread distribution")
        .logScale(),
    integer("cells", 3, {1, 8}, "cells", "Kernels are divided into so many parts along each axis").quality(),
    integer("search_rounds", 2, {0, 8}, "rounds",
            "How often the search kernel is narrowed to the nearest depth in it; 0: at the near plane, as "
            "published"),
    integer("passes", 3, {1, 8}, "passes",
            "Penumbra kernels, each at the blockers of the one before, while those are much nearer than it")
        .quality(),
    integer("direct_texels", 8, {0, 32}, "texels",
            "Penumbra kernels up to this width are filtered texel by texel"),
    integer("moment_bits", 0, {0, 20}, "bits",
            "Of each moment of a texel, 10 to 20; 0: by the size of the shadow map"),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase stress[] = {
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
};

class MomentSoftShadowMap : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    shadow::VisibilityPass pass = shadow::visibilityPass(inputs, request, info.name);
    const shadow::MomentTable table = inputs.shadowMaps.momentTable(pass.maps, p.integer("moment_bits"));
    pass.sampled = {{shadow::minMaxUnit, inputs.shadowMaps.minMaxPyramid(pass.maps).texture,
                     "least and greatest depth in a kernel"},
                    {shadow::tableUnit, table.texture, "moments of depth in a kernel"}};
    pass.bind = [bits = table.bits, bias = p.real("moment_bias"), rounds = p.integer("search_rounds"),
                 direct = p.integer("direct_texels"), passes = p.integer("passes"),
                 cells = p.integer("cells")](frame::PassContext&, gpu::Program& program) {
      program.set("moment_bits", bits);
      program.set("moment_bias", bias);
      program.set("search_rounds", rounds);
      program.set("direct_texels", direct);
      program.set("cells", cells);
      program.set("passes", passes);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "moment_soft_shadow_map",
      .title = "Moment soft shadow maps",
      .source =
          "Peters and Klein 2015, Moment Shadow Mapping; Peters et al. 2017, Improved Moment Shadow Maps",
      .terms = termSet(Term::visibility),
      .parameters = parameters,
      .stress = stress};
};

}  // namespace

LIMN_TECHNIQUE(MomentSoftShadowMap::info, MomentSoftShadowMap)
