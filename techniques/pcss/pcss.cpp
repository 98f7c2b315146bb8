// Percentage-closer soft shadows (Fernando 2005): a blocker search, then a filter as wide as the penumbra.
#include "core/shadow/sample_batches.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kPatterns[] = {"grid", "r2"};
constexpr const char* kSearches[] = {"near", "cone", "narrowed"};
constexpr Parameter kParameters[] = {
    integer("blocker_samples", 32, {1, 4096}, "samples", "Point samples of the blocker search")
        .quality()
        .logScale(),
    integer("filter_samples", 64, {1, 4096}, "samples", "Point samples of the penumbra kernel")
        .quality()
        .logScale(),
    choice("pattern", 1, kPatterns, "Regular grid, or the R2 sequence shifted in each pixel"),
    choice("search", 1, kSearches,
           "Search at the near plane, as published, through the cone from receiver to light, keeping what "
           "lies in it, or at the nearest depth that bounds of the depths find, ending where they prove V"),
    integer("search_rounds", 6, {0, 9}, "rounds",
            "How often the nearest depth in the search kernel narrows it; search=narrowed"),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(1),
    shadow::viewsParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "one sample each", .settings = "blocker_samples=1 filter_samples=1", .factor = 4},
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
    {.name = "published search, light of 3 scene radii",
     .change = StressChange::lightSize,
     .amount = 3,
     .settings = "search=near"},
    {.name = "narrowed search", .settings = "search=narrowed"},
    {.name = "search kernel moved once", .settings = "search=narrowed search_rounds=1"},
};

class Pcss : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    shadow::VisibilityPass pass = shadow::visibilityPass(
        inputs, request, info.name,
        {{"PATTERN", std::to_string(p.choice("pattern"))}, {"SEARCH", std::to_string(p.choice("search"))}});
    shadow::checkSamplesOfParts(inputs, info.name, pass.maps,
                                p.integer("blocker_samples") + p.integer("filter_samples"));
    const bool narrowed = p.choice("search") == 2;
    if (narrowed) {
      pass.sampled = {{"shadow_min_max", inputs.service<shadow::ShadowMapService>().minMaxWindows(pass.maps),
                       "how far the search kernel reaches"}};
    }
    pass.bind = [narrowed, rounds = p.integer("search_rounds"), blockers = p.integer("blocker_samples"),
                 filters = p.integer("filter_samples")](frame::PassContext&, gpu::Program& program) {
      if (narrowed) program.set("search_rounds", rounds);
      program.set("blocker_samples", blockers);
      program.set("filter_samples", filters);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{.name = "pcss",
                                      .title = "Percentage-closer soft shadows",
                                      .source = "Fernando 2005, Percentage-Closer Soft Shadows",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(Pcss::info, Pcss)
