// Percentage-closer filtering (Reeves, Salesin, Cook 1987): depth comparisons averaged over a fixed kernel.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr unsigned minMaxUnit = 9;  // as in glsl/blocker_search.glsl

constexpr Parameter parameters[] = {
    real("kernel", 5, {1, 64}, "texels", "Width and height of the filter").quality().logScale(),
    shadow::shadowMapSizeParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};

class Pcf : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    shadow::VisibilityPass pass = shadow::visibilityPass(inputs, request, info.name);
    const frame::TextureHandle bounds = inputs.shadowMaps.minMaxPyramid(pass.maps).texture;
    pass.declare = [bounds](frame::PassBuilder& builder) {
      builder.read(bounds, frame::Access::sampled, "least and greatest depth in a kernel");
    };
    pass.bind = [bounds, kernel = inputs.parameters.real("kernel")](frame::PassContext& context,
                                                                    gpu::Program& program) {
      context.bindSampled(minMaxUnit, bounds);
      program.set("kernel_width", kernel);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "pcf",
      .title = "Percentage-closer filtering",
      .source = "Reeves, Salesin, Cook 1987, Rendering Antialiased Shadows with Depth Maps",
      .terms = termSet(Term::visibility),
      .parameters = parameters};
};

}  // namespace

LIMN_TECHNIQUE(Pcf::info, Pcf)
