// @NAME@: percentage-closer filtering (Reeves et al. 1987), to be replaced by your own method.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr Parameter parameters[] = {
    integer("taps", 4, {1, 64}, "texels", "Width and height of the filter").quality(),
    integer("shadow_map_size", 1024, {16, 16384}, "texels", "Width and height of each layer of the shadow maps")
        .quality()
        .logScale(),
};

class @CLASS@ : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    return shadow::addVisibilityPass(
        graph, inputs, request.target,
        {.name = "visibility",
         .technique = info.name,
         .program = {.files = {"techniques/@NAME@/visibility.comp.glsl"}},
         .maps = inputs.shadowMaps.request(request.lights, {.size = p.integer("shadow_map_size")}),
         .bind = [taps = p.integer("taps")](frame::PassContext&, gpu::Program& program) {
           program.set("taps", taps);
         }});
  }

 public:
  static constexpr TechniqueInfo info{.name = "@NAME@",
                                      .title = "@NAME@",
                                      .source = "Reeves, Salesin, Cook 1987",
                                      .terms = termSet(Term::visibility),
                                      .parameters = parameters};
};

}  // namespace

LIMN_TECHNIQUE(@CLASS@::info, @CLASS@)
