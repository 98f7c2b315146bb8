// Declares the light that enters translucent bodies at places where pixels need not be.
#pragma once

#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/gpu/objects.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/technique.h"

namespace limn::shadow {

/// Holds what a pass that includes glsl/shadow/entering_light.glsl reads: what enters in the picture and, for
/// places that the camera does not see, a shadow map of each light of a request.
class LIMN_API EnteringLight {
 public:
  /// Requests maps of `size` texels of the lights of a request; none where it has none.
  EnteringLight(const TechniqueInputs& inputs, const TermRequest& request, int size);
  /// Declares the reads, and adds to the program's defines.
  void declare(frame::PassBuilder& pass, const TechniqueInputs& inputs,
               std::map<std::string, std::string>& defines) const;
  /// Sets the plain uniforms. `bias` is in texel footprints.
  void set(gpu::Program& program, float bias) const;

 private:
  ShadowMaps maps_;
  size_t lights_;
};

}  // namespace limn::shadow
