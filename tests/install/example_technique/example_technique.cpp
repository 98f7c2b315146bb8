// Constant visibility: the smallest technique that answers a term.
#include "core/technique/technique.h"

namespace {

using limn::frame::Access;

constexpr limn::Parameter kParameters[] = {
    limn::real("value", 1.0, {0, 1}, "", "Visibility of every light at every pixel"),
};

constexpr limn::StressCase kStress[] = {
    {.name = "all dark", .settings = "value=0", .factor = 100},
};

class ExampleTechnique : public limn::Technique {
  limn::frame::TextureHandle addPasses(limn::frame::FrameGraph& graph, const limn::TechniqueInputs& inputs,
                                       const limn::TermRequest& request) override {
    limn::frame::PassBuilder pass = graph.addPass("constant", "example_technique");
    const auto target =
        pass.write(request.target, Access::imageStore, "visibility", "visibility, a layer per light");
    const auto program = pass.program({{"techniques/example_technique/constant.comp.glsl"}, {}});
    const glm::ivec2 size = inputs.size;
    const int layers = static_cast<int>(request.lights.size());
    const float value = inputs.parameters.real("value");
    pass.execute([=](limn::frame::PassContext& context) {
      context.use(program).set("value", value);
      context.dispatch(size.x, size.y, layers, 8, 8);
    });
    return target;
  }
};

constexpr limn::TechniqueInfo kInfo{.name = "example_technique",
                                    .title = "Constant visibility",
                                    .source = "an example",
                                    .terms = limn::termSet(limn::Term::visibility),
                                    .parameters = kParameters,
                                    .stress = kStress};

}  // namespace

LIMN_TECHNIQUE(kInfo, ExampleTechnique)
