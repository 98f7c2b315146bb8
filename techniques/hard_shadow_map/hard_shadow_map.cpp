// Shadow mapping (Williams 1978): one depth comparison per pixel and light.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* filters[] = {"nearest", "2x2"};
constexpr Parameter parameters[] = {
    integer("shadow_map_size", 1024, {16, 16384}, "texels",
            "Width and height of each layer of the shadow maps")
        .quality()
        .logScale(),
    real("bias", 1, {0, 64}, "texel footprints",
         "How far a blocker must lie above the receiver's tangent plane to count"),
    choice("filter", 0, filters, "One texel, or the four around the receiver weighted bilinearly"),
};

class HardShadowMap : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    const char* filter = p.choice("filter") == 0 ? "0" : "1";
    return shadow::addVisibilityPass(
        graph, inputs, request.target,
        {.name = "visibility",
         .technique = info.name,
         .program = {.files = {"techniques/hard_shadow_map/visibility.comp.glsl"},
                     .defines = {{"FILTER", filter}}},
         .maps = inputs.shadowMaps.request(request.lights, {.size = p.integer("shadow_map_size")}),
         .bias = p.real("bias")});
  }

 public:
  static constexpr TechniqueInfo info{.name = "hard_shadow_map",
                                      .title = "Hard shadow mapping",
                                      .source = "Williams 1978, Casting Curved Shadows on Curved Surfaces",
                                      .terms = termSet(Term::visibility),
                                      .parameters = parameters};
};

}  // namespace

LIMN_TECHNIQUE(HardShadowMap::info, HardShadowMap)
