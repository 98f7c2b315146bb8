#include "core/scene/subsurface.h"

#include "glsl/diffusion/normalised.glsl"

namespace limn::scene {
namespace {

glsl::WalkReflectance walkOf(float ior) {
  return glsl::walk_reflectance(glsl::diffusion_boundary(subsurfaceIor(ior)));
}

}  // namespace

glm::vec3 subsurfaceAlbedo(const glm::vec3& absorption, float ior) {
  const glsl::WalkReflectance walk = walkOf(ior);
  return {glsl::walk_albedo(walk, absorption.x), glsl::walk_albedo(walk, absorption.y),
          glsl::walk_albedo(walk, absorption.z)};
}

glm::vec3 subsurfaceAbsorption(const glm::vec3& albedo, float ior) {
  return glsl::walk_absorption(walkOf(ior), albedo);
}

}  // namespace limn::scene
