#include "core/shadow/micro_patches.h"

#include <utility>

namespace limn::shadow {

VisibilityPass microPatchPass(const TechniqueInputs& inputs, const TermRequest& request,
                              std::string_view technique, std::map<std::string, std::string> defines) {
  const ParameterValues& p = inputs.parameters;
  VisibilityPass pass = visibilityPass(inputs, request, technique, std::move(defines));
  pass.sampled = {{"shadow_min_max", inputs.service<ShadowMapService>().minMaxPyramid(pass.maps).texture,
                   "nearest and farthest depths"}};
  pass.bind = [patches = p.integer("patches"), rounds = p.integer("search_rounds")](frame::PassContext&,
                                                                                    gpu::Program& program) {
    program.set("patches", patches);
    program.set("search_rounds", rounds);
  };
  return pass;
}

}  // namespace limn::shadow
