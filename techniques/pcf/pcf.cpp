// Percentage-closer filtering (Reeves, Salesin, Cook 1987): depth comparisons averaged over a fixed kernel.
#include <cmath>

#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter kParameters[] = {
    real("kernel", 5, {1, 64}, "texels", "Width and height of the filter").quality().logScale(),
    shadow::shadowMapSizeParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "map of 16 texels", .settings = "shadow_map_size=16", .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
};

class Pcf : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    shadow::VisibilityPass pass = shadow::visibilityPass(inputs, request, info.name);
    const float kernel = inputs.parameters.real("kernel");
    // A kernel touches the texels that its edges cut as well.
    const int texels = static_cast<int>(std::ceil(kernel)) + 1;
    pass.sampled = {{"shadow_min_max",
                     inputs.service<shadow::ShadowMapService>().minMaxPyramid(pass.maps, texels).texture,
                     "least and greatest depth in a kernel"}};
    pass.bind = [kernel](frame::PassContext&, gpu::Program& program) { program.set("kernel_width", kernel); };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "pcf",
      .title = "Percentage-closer filtering",
      .source = "Reeves, Salesin, Cook 1987, Rendering Antialiased Shadows with Depth Maps",
      .terms = termSet(Term::visibility),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(Pcf::info, Pcf)
