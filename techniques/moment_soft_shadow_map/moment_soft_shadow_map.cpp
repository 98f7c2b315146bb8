// Moment soft shadow maps (Peters and Klein 2015, Peters et al. 2017): percentage-closer soft shadows of
// which both steps are prefiltered from four power moments of depth.
#include <cstdlib>

#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kMomentBits[] = {"0", "10", "11", "12", "13", "14", "15", "16", "17", "18", "19", "20"};
constexpr Parameter kParameters[] = {
    real("moment_bias", 1e-6, {1e-7, 0.1}, "",
         "Share by which moments are pulled towards those of a well-spread distribution")
        .logScale(),
    integer("cells", 3, {1, 8}, "cells", "Parts into which kernels are divided along each axis").quality(),
    integer("search_rounds", 3, {0, 9}, "rounds",
            "How often the search kernel is narrowed to the nearest depth in it; 0: at the near plane, as "
            "published"),
    real("search_blur", 4, {0, 1024}, "texels",
         "How far beside the cone to the light a part of the search kernel may lie and still count"),
    integer("passes", 3, {1, 8}, "passes",
            "Penumbra kernels, each at the blockers of the one before, while those are much nearer than it")
        .quality(),
    real("least_gap", 0.05, {0.001, 1}, "kernel distances",
         "Blockers nearer to the receiver than this count as if at this distance")
        .logScale(),
    integer("direct_texels", 8, {0, 32}, "texels",
            "Penumbra kernels up to this width are filtered texel by texel"),
    choice("moment_bits", 0, kMomentBits, "Bits of each moment of a texel; 0: by the size of the shadow map"),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(),
    shadow::viewsParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
    {.name = "the cone alone searched", .settings = "search_blur=0"},
    {.name = "all of the search kernel", .settings = "search_blur=1024"},
    {.name = "blockers in contact", .settings = "least_gap=0.001"},
    {.name = "blockers all at the kernel", .settings = "least_gap=1", .factor = 3},
};

class MomentSoftShadowMap : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    shadow::VisibilityPass pass = shadow::visibilityPass(inputs, request, info.name);
    const shadow::MomentTable table = inputs.service<shadow::ShadowMapService>().momentTable(
        pass.maps, std::atoi(kMomentBits[p.choice("moment_bits")]));
    pass.sampled = {
        {"shadow_min_max", inputs.service<shadow::ShadowMapService>().minMaxPyramid(pass.maps).texture,
         "least and greatest depth in a kernel"},
        {"moment_table", table.texture, "moments of depth in a kernel"}};
    pass.bind = [bits = table.bits, bias = p.real("moment_bias"), rounds = p.integer("search_rounds"),
                 direct = p.integer("direct_texels"), passes = p.integer("passes"),
                 cells = p.integer("cells"), blur = p.real("search_blur"),
                 leastGap = p.real("least_gap")](frame::PassContext&, gpu::Program& program) {
      program.set("moment_bits", bits);
      program.set("moment_bias", bias);
      program.set("search_rounds", rounds);
      program.set("direct_texels", direct);
      program.set("cells", cells);
      program.set("passes", passes);
      program.set("search_blur", blur);
      program.set("least_gap", leastGap);
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
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(MomentSoftShadowMap::info, MomentSoftShadowMap)
