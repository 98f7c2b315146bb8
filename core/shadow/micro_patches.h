// Declares what techniques that look at a shadow map's texels as micro-patches share
// (glsl/shadow/micro_patch_walk.glsl): parameters, and the pass.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/shadow/visibility_pass.h"

namespace limn::shadow {

constexpr int kFewestPatches = 3;  ///< along a side

constexpr Parameter patchesParameter() {
  return integer("patches", 32, {kFewestPatches, 1024}, "micro-patches",
                 "Micro-patches along each side of a kernel, at most; wider kernels are walked in steps of "
                 "several texels")
      .quality()
      .logScale();
}
constexpr Parameter patchSearchRoundsParameter() {
  return integer("search_rounds", 8, {0, 16}, "rounds",
                 "How often the kernel is narrowed by the min-max pyramid, at most; 0: at the near plane")
      .quality();
}

/// Returns the visibilityPass() of a technique that declares these parameters, with the min-max pyramid of
/// its maps.
LIMN_API VisibilityPass microPatchPass(const TechniqueInputs& inputs, const TermRequest& request,
                                       std::string_view technique,
                                       std::map<std::string, std::string> defines = {});

}  // namespace limn::shadow
