// Bitmask soft shadows (Schwarz and Stamminger 2007).
#include "core/shadow/micro_patches.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kSampleCounts[] = {"64", "128", "256"};
constexpr Parameter kParameters[] = {
    choice("sample_points", 0, kSampleCounts, "Sample points on the light, one bit each").quality(),
    shadow::patchesParameter(),
    shadow::patchSearchRoundsParameter(),
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
    const int words = 2 << inputs.parameters.choice("sample_points");
    return shadow::addVisibilityPass(
        graph, inputs, request.target,
        shadow::microPatchPass(inputs, request, info.name, {{"WORDS", std::to_string(words)}}));
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
