// Percentage-closer soft shadows (Fernando 2005): a blocker search, then a filter as wide as the penumbra.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* patterns[] = {"grid", "r2"};
constexpr const char* searches[] = {"near", "cone"};
constexpr Parameter parameters[] = {
    integer("blocker_samples", 32, {1, 4096}, "samples", "Point samples of the blocker search")
        .quality()
        .logScale(),
    integer("filter_samples", 64, {1, 4096}, "samples", "Point samples of the penumbra kernel")
        .quality()
        .logScale(),
    choice("pattern", 1, patterns, "Regular grid, or the R2 sequence shifted in each pixel"),
    choice("search", 1, searches,
           "Search at the near plane, as published, or through the cone from receiver to light, keeping what "
           "lies in it"),
    integer("shadow_map_size", 1024, {16, 16384}, "texels",
            "Width and height of each layer of the shadow maps")
        .quality()
        .logScale(),
    real("bias", 1, {0, 64}, "texel footprints",
         "How far a blocker must lie above the receiver's tangent plane to count"),
    real("light_size", -1, {-1, 1e6}, "m",
         "Side of every light (directional: angular diameter in radians); negative: the scene's"),
};

class Pcss : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    const int blockerSamples = p.integer("blocker_samples"), filterSamples = p.integer("filter_samples");
    return shadow::addVisibilityPass(
        graph, inputs, request.target,
        {.name = "visibility",
         .technique = info.name,
         .program = {.files = {"techniques/pcss/visibility.comp.glsl"},
                     .defines = {{"PATTERN", std::to_string(p.choice("pattern"))},
                                 {"SEARCH", std::to_string(p.choice("search"))}}},
         .maps = inputs.shadowMaps.request(request.lights, {.size = p.integer("shadow_map_size")}),
         .bias = p.real("bias"),
         .lightSize = p.real("light_size"),
         .bind = [=](frame::PassContext&, gpu::Program& program) {
           program.set("blocker_samples", blockerSamples);
           program.set("filter_samples", filterSamples);
         }});
  }

 public:
  static constexpr TechniqueInfo info{.name = "pcss",
                                      .title = "Percentage-closer soft shadows",
                                      .source = "Fernando 2005, Percentage-Closer Soft Shadows",
                                      .terms = termSet(Term::visibility),
                                      .parameters = parameters};
};

}  // namespace

LIMN_TECHNIQUE(Pcss::info, Pcss)
