// Soft shadows from summed-area variance shadow maps: the baseline of vssm.
#include <fmt/format.h>

#include "core/shadow/sample_batches.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kPatterns[] = {"grid", "r2"};
constexpr const char* kSearches[] = {"near", "cone"};

constexpr Parameter kParameters[] = {
    integer("blocker_samples", 64, {1, 4096}, "samples", "Point samples of the blocker search")
        .quality()
        .logScale(),
    choice("pattern", 1, kPatterns, "Regular grid, or the R2 sequence shifted in each pixel"),
    choice("search", 1, kSearches,
           "Search at the near plane, as published, or through the cone from receiver to light, keeping what "
           "lies in it"),
    integer("sat_bits", 16, {8, 24}, "bits", "Of a depth in the summed-area table"),
    integer("sat_words", 2, {1, 2}, "32-bit words", "Per moment; 1: squares rounded, as published"),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(1),
    shadow::viewsParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "one blocker sample", .settings = "blocker_samples=1", .factor = 4},
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
};

class Savsm : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    shadow::VisibilityPass pass = shadow::visibilityPass(
        inputs, request, info.name,
        {{"PATTERN", std::to_string(p.choice("pattern"))}, {"SEARCH", std::to_string(p.choice("search"))}});
    // Where the light's centre lies beneath the tangent plane the penumbra kernel takes as many again.
    shadow::checkSamplesOfParts(inputs, info.name, pass.maps, 2 * p.integer("blocker_samples"));
    // A kernel may be the whole map.
    const shadow::SummedAreaTable table = shadow::summedAreaTable(inputs, pass.maps, pass.maps.size);
    pass.program.defines["TABLE_FORMAT"] = fmt::format("{}u", table.format);
    pass.sampled = {{"shadow_table", table.texture, "moments of kernels"}};
    pass.bind = [blockers = p.integer("blocker_samples")](frame::PassContext&, gpu::Program& program) {
      program.set("blocker_samples", blockers);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{.name = "savsm",
                                      .title = "Summed-area variance shadow maps",
                                      .source = "Lauritzen 2007, Summed-Area Variance Shadow Maps",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(Savsm::info, Savsm)
