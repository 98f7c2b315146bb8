#include "core/shadow/micro_patches.h"

#include <cstdint>
#include <utility>

#include "core/shadow/sample_batches.h"

namespace limn::shadow {
namespace {

/// Returns as many of the patches along each side of a kernel as a pixel gets through.
int walkedPatches(const TechniqueInputs& inputs, const ShadowMaps& maps, int patches) {
  constexpr int kStrip = 5;  // rows of which a step takes one patch each: glsl/shadow/patch_box.glsl
  const int64_t most = mostStepsOfLoops(inputs);
  for (const LightLayout& layout : inputs.service<ShadowMapService>().layouts(maps)) {
    const uint32_t faces =
        glsl::shadow_views_apart(layout.faces) ? 1u : glsl::shadow_face_count(layout.faces);
    const int64_t walks = int64_t{layout.parts()} * faces;
    while (patches > kFewestPatches && walks * (patches / kStrip + 1) * (patches + 1) > most) --patches;
  }
  return patches;
}

}  // namespace

VisibilityPass microPatchPass(const TechniqueInputs& inputs, const TermRequest& request,
                              std::string_view technique, std::map<std::string, std::string> defines) {
  const ParameterValues& p = inputs.parameters;
  VisibilityPass pass = visibilityPass(inputs, request, technique, std::move(defines));
  pass.sampled = {{"shadow_min_max", inputs.service<ShadowMapService>().minMaxPyramid(pass.maps).texture,
                   "nearest and farthest depths"}};
  pass.bind = [patches = walkedPatches(inputs, pass.maps, p.integer("patches")),
               rounds = p.integer("search_rounds")](frame::PassContext&, gpu::Program& program) {
    program.set("patches", patches);
    program.set("search_rounds", rounds);
  };
  return pass;
}

}  // namespace limn::shadow
